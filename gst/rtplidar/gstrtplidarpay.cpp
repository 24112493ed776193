// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-rtplidarpay
 *
 * Sends encoded clouds, one slice a buffer, as RTP (docs/wire-format.md).
 *
 * |[
 * gst-launch-1.0 lidartestsrc ! lidarenc ! rtplidarpay ! udpsink host=127.0.0.1 port=5004
 * ]|
 */
#include <gst/rtp/gstrtpbasepayload.h>

#include <mutex>

#include "gst/common/element_class.h"
#include "gst/common/latency.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/common/refused_caps.h"
#include "gst/common/stats.h"
#include "gst/lidar/gstlidar.h"
#include "gst/rtplidar/base_stats.h"
#include "gst/rtplidar/config_caps.h"
#include "gst/rtplidar/pay_slices.h"
#include "gst/rtplidar/receipts.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_rtp_pay_debug);
#define GST_CAT_DEFAULT gst_lidar_rtp_pay_debug

namespace {

using namespace lidar::gst;
using Settings = PaySettings;

constexpr guint kClockRate = 90'000;

using Counters = PayCounters;
const std::array<Stat<Counters>, 7> kStats = {{
    {"scans-sent", &Counters::scans},
    {"slices-sent", &Counters::slices},
    {"packets-sent", &Counters::packets},
    {"configs-sent", &Counters::configs},
    {"slice-bytes", &Counters::slice_bytes},
    {"payload-bytes", &Counters::payload_bytes},
    {"empty-dropped", &Counters::empty},
}};

struct State : PayState {
  Receipts receipts;
  GstClockTime scan_time = 0;  // duration of a scan by the caps; 0: not known; guarded by mutex
  RefusedCaps refused;
  GstPadQueryFunction base_src_query = nullptr;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarRtpPay, gst_lidar_rtp_pay, GST_LIDAR, RTP_PAY, GstRTPBasePayload)
struct _GstLidarRtpPay {
  GstRTPBasePayload parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarRtpPay, gst_lidar_rtp_pay, GST_TYPE_RTP_BASE_PAYLOAD)
// The rank is NONE, because the element accepts any caps. Otherwise it would be found in a search
// for a payloader of video.
GST_ELEMENT_REGISTER_DEFINE(rtplidarpay, "rtplidarpay", GST_RANK_NONE, gst_lidar_rtp_pay_get_type())

static StructurePtr Stats(GObject* object) {
  State& state = *GST_LIDAR_RTP_PAY(object)->state;
  auto stats = BaseClassStats(object, gst_lidar_rtp_pay_parent_class);
  std::lock_guard lock(state.mutex);
  AddStats(stats.get(), kStats, state.counters);
  return stats;
}

static const std::array<Property<Settings>, 3> kProperties = {{
    {"config-interval",
     "Time between repetitions of the stream config, which late receivers need; 0: only before the "
     "first slice and after changes [s]",
     &Settings::config_interval_s, 0, 3600, GST_PARAM_MUTABLE_PLAYING},
    {"aggregate",
     "Aggregate small slices of one scan in a packet: fewer headers, more delay, which max-ptime "
     "bounds",
     &Settings::aggregate, 0, 0, GST_PARAM_MUTABLE_PLAYING},
    {"stats", "Counters of sent data, in addition to the fields of every RTP payloader", Stats},
}};

static GstFlowReturn HandleBuffer(GstRTPBasePayload* base, GstBuffer* buffer) {
  const BufferPtr owner(buffer);
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  const GstFlowReturn flow = PaySliceBuffer(base, state, buffer);
  if (flow == GST_FLOW_OK) UpdateBounds(base, state);
  return flow;
}

/// Returns "video" if downstream accepts no other media. An example is WebRTC, which has no media
/// type for LiDAR.
static const gchar* MediaDownstream(GstRTPBasePayload* base) {
  const CapsPtr allowed(gst_pad_get_allowed_caps(GST_RTP_BASE_PAYLOAD_SRCPAD(base)));
  const CapsPtr usual(
      gst_caps_new_simple("application/x-rtp", "media", G_TYPE_STRING, "application", nullptr));
  const bool any = !allowed || gst_caps_is_empty(allowed.get());
  return any || gst_caps_can_intersect(allowed.get(), usual.get()) ? "application" : "video";
}

/// Stores the duration of a scan. If the latency depends on it because of aggregation, posts a
/// latency message.
static void SetScanTime(GstRTPBasePayload* base, State& state) {
  const auto& config = *state.config;
  const GstClockTime scan_time =
      config.framerate_n > 0
          ? gst_util_uint64_scale(GST_SECOND, config.framerate_d, config.framerate_n)
          : 0;
  bool changed = false;
  {
    std::lock_guard lock(state.mutex);
    changed = state.settings.aggregate && scan_time != state.scan_time;
    state.scan_time = scan_time;
  }
  if (changed) PostNewLatency(base);
}

static gboolean SetCaps(GstRTPBasePayload* base, GstCaps* caps) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  std::string why;
  auto config = StreamConfigFromCaps(caps, &why);
  if (!config) {
    if (!state.refused.Note(caps)) return FALSE;
    GST_ELEMENT_ERROR(
        base, STREAM, FORMAT,
        ("The caps do not describe an encoded cloud that can be sent: %s.", why.c_str()),
        ("caps are %" GST_PTR_FORMAT, static_cast<void*>(caps)));
    return FALSE;
  }
  state.refused.Reset();
  PushAggregate(base, state);
  if (state.config != config) {
    const bool first = !state.config.has_value();
    state.config = std::move(config);
    state.config_bytes = state.config->Serialise();
    state.config_id = lidar::rtp::ConfigId(
        state.config_bytes, first ? std::nullopt : std::optional<std::uint8_t>(state.config_id));
    std::lock_guard lock(state.mutex);
    state.config_due = true;
  }
  SetScanTime(base, state);
  gst_rtp_base_payload_set_options(base, MediaDownstream(base), TRUE, "X-LIDAR-DRACO", kClockRate);
  return gst_rtp_base_payload_set_outcaps(base, nullptr);
}

static gboolean SinkEvent(GstRTPBasePayload* base, GstEvent* event) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  GstLidarBitrateBounds bounds{};
  if (gst_lidar_event_parse_bitrate_bounds(event, &bounds)) {
    state.bounds = bounds;
    gst_event_unref(event);
    event = BoundsWithHeaders(base, state);
  }
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_EOS:
    case GST_EVENT_SEGMENT:
      PushAggregate(base, state);
      break;
    case GST_EVENT_FLUSH_STOP: {
      state.aggregator.Take();
      std::lock_guard lock(state.mutex);
      state.config_due = true;
      break;
    }
    default:
      break;
  }
  return GST_RTP_BASE_PAYLOAD_CLASS(gst_lidar_rtp_pay_parent_class)->sink_event(base, event);
}

/// Returns a copy of `event` for the encoder, in which bitrates do not include the headers of
/// packets. Unknown fields are kept. `share` is the share of the encoder's bytes in the payload.
static GstEvent* WithoutHeaders(GstEvent* event, gdouble share) {
  GstStructure* s = gst_structure_copy(gst_event_get_structure(event));
  for (const char* name : {"bitrate", "min-bitrate", "max-bitrate"}) {
    guint bps = 0;
    if (gst_structure_get_uint(s, name, &bps))
      gst_structure_set(s, name, G_TYPE_UINT, static_cast<guint>(bps * share), nullptr);
  }
  GstEvent* out = gst_event_new_custom(GST_EVENT_TYPE(event), s);
  gst_event_set_seqnum(out, gst_event_get_seqnum(event));
  return out;
}

/// Returns true if the config must be sent at once, because a receiver needs a start point or
/// because the SSRC will change.
static bool WantsConfig(GstEvent* event) {
  return GST_EVENT_TYPE(event) == GST_EVENT_CUSTOM_UPSTREAM &&
         (gst_event_has_name(event, "GstForceKeyUnit") ||
          gst_event_has_name(event, "GstRTPCollision"));
}

static gboolean SrcEvent(GstRTPBasePayload* base, GstEvent* event) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  GstEvent* receipt = nullptr;
  if (state.receipts.OnEvent(event, &receipt)) {
    gst_event_unref(event);
    if (receipt != nullptr) gst_pad_push_event(GST_RTP_BASE_PAYLOAD_SINKPAD(base), receipt);
    return TRUE;
  }
  GstLidarTargetBitrate target{};
  if (gst_lidar_event_parse_target_bitrate(event, &target)) {
    GstEvent* out = WithoutHeaders(event, SliceShare(base, state));
    gst_event_unref(event);
    event = out;
  } else if (WantsConfig(event)) {
    std::lock_guard lock(state.mutex);
    state.config_due = true;
  }
  return GST_RTP_BASE_PAYLOAD_CLASS(gst_lidar_rtp_pay_parent_class)->src_event(base, event);
}

/// Returns the longest time that a slice waits in an aggregate, or 0 without aggregation.
static GstClockTime HoldTime(GstRTPBasePayload* base) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  std::lock_guard lock(state.mutex);
  if (!state.settings.aggregate) return 0;
  return base->max_ptime >= 0 ? MIN(state.scan_time, static_cast<GstClockTime>(base->max_ptime))
                              : state.scan_time;
}

/// Posts a latency message if a property that affects HoldTime() has changed. max-ptime is a
/// property of the base class.
static void NotifyChange(GObject* object, GParamSpec* spec) {
  if (g_strcmp0(spec->name, "aggregate") == 0 || g_strcmp0(spec->name, "max-ptime") == 0)
    PostNewLatency(object);
}

static gboolean SrcQuery(GstPad* pad, GstObject* parent, GstQuery* query) {
  if (!GST_LIDAR_RTP_PAY(parent)->state->base_src_query(pad, parent, query)) return FALSE;
  if (GST_QUERY_TYPE(query) != GST_QUERY_LATENCY) return TRUE;
  AddLatency(query, HoldTime(GST_RTP_BASE_PAYLOAD(parent)));
  return TRUE;
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  State& state = *GST_LIDAR_RTP_PAY(element)->state;
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    std::lock_guard lock(state.mutex);
    state.counters = {};
    state.recent_slice_bytes = state.recent_payload_bytes = 0;
    state.config_due = true;
    state.config.reset();
    state.scan_time = 0;
    state.refused.Reset();
    state.config_sent_at = GST_CLOCK_TIME_NONE;
    state.scans = lidar::rtp::ScanCounter(g_random_int());
    state.last_scan.reset();
    state.unnamed_scans = 0;
    state.aggregator = {};
    state.bounds.reset();
  }
  return GST_ELEMENT_CLASS(gst_lidar_rtp_pay_parent_class)->change_state(element, transition);
}

static void gst_lidar_rtp_pay_init(GstLidarRtpPay* self) {
  self->state = new State;
  GstPad* src = GST_RTP_BASE_PAYLOAD_SRCPAD(self);
  self->state->base_src_query = GST_PAD_QUERYFUNC(src);
  gst_pad_set_query_function(src, SrcQuery);
  self->state->receipts.Watch(src);
}

static void gst_lidar_rtp_pay_class_init(GstLidarRtpPayClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_rtp_pay_debug, "rtplidarpay", 0, "RTP payloader for clouds");
  ServeState<GstLidarRtpPay, gst_lidar_rtp_pay_parent_class, kProperties>(klass);
  G_OBJECT_CLASS(klass)->notify = NotifyChange;
  auto* element = GST_ELEMENT_CLASS(klass);
  Describe(klass,
           {"RTP payloader for point clouds", "Codec/Payloader/Network/RTP",
            "Sends slices of encoded clouds as RTP"},
           {{"sink", GST_PAD_SINK, "ANY"},
            {"src", GST_PAD_SRC,
             "application/x-rtp, media = (string) { application, video }, "
             "payload = (int) [ 96, 127 ], "
             "clock-rate = (int) 90000, encoding-name = (string) X-LIDAR-DRACO"}});
  element->change_state = ChangeState;
  auto* pay = GST_RTP_BASE_PAYLOAD_CLASS(klass);
  pay->set_caps = SetCaps;
  pay->handle_buffer = HandleBuffer;
  pay->sink_event = SinkEvent;
  pay->src_event = SrcEvent;
}
