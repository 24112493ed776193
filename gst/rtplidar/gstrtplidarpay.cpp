// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-rtplidarpay
 *
 * Sends encoded clouds, one slice a buffer, as RTP (docs/wire-format.md).
 *
 * |[
 * gst-launch-1.0 lidartestsrc ! dracoenc ! rtplidarpay ! udpsink host=127.0.0.1 port=5004
 * ]|
 */
#include "rtplidar/gstrtplidarpay.h"

#include <gst/rtp/gstrtpbuffer.h>

#include <mutex>
#include <optional>

#include "common/buffer_map.h"
#include "common/gstlidar.h"
#include "common/properties.h"
#include "common/refs.h"
#include "rtp/ntp_time.h"
#include "rtp/packetizer.h"
#include "rtplidar/base_stats.h"
#include "rtplidar/config_caps.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_rtp_pay_debug);
#define GST_CAT_DEFAULT gst_lidar_rtp_pay_debug

using lidar::gst::BufferListPtr;
using lidar::gst::BufferMap;
using lidar::gst::BufferPtr;
using lidar::gst::CapsPtr;
using lidar::gst::EventPtr;

namespace {

constexpr guint kClockRate = 90'000;
// Of the bytes behind `stats`, so that the share of the headers follows the last second or so.
constexpr gdouble kShareMemory = 0.98;

struct Settings {
  guint config_interval_s = 1;
  bool aggregate = false;
};

const std::array<lidar::gst::Property<Settings>, 2> kProperties = {{
    {"config-interval",
     "Time between repetitions of the stream config, by which receivers join late; 0: only before "
     "the first slice and when it changes [s]",
     &Settings::config_interval_s, 0, 3600, GST_PARAM_MUTABLE_PLAYING},
    {"aggregate",
     "Put small slices of one scan together into one packet: fewer headers, more delay (max-ptime "
     "bounds it)",
     &Settings::aggregate, 0, 0, GST_PARAM_MUTABLE_PLAYING},
}};
constexpr guint kStatsId = kProperties.size() + 1;

struct Counters {
  guint64 scans = 0;
  guint64 slices = 0;
  guint64 packets = 0;
  guint64 configs = 0;
  guint64 slice_bytes = 0;
  guint64 payload_bytes = 0;  // with our headers
  guint64 empty = 0;          // buffers without a byte, not sent
};

/// What one buffer brings: its unit and what GStreamer knows of it.
struct Slice {
  lidar::rtp::Unit unit;
  GstLidarSlice meta{};
  GstClockTime pts = GST_CLOCK_TIME_NONE;
  GstClockTime duration = GST_CLOCK_TIME_NONE;
};

struct State {
  std::mutex mutex;  // guards settings, counters, share and config_due; never held while pushing
  Settings settings;
  Counters counters;
  gdouble recent_slice_bytes = 0;
  gdouble recent_payload_bytes = 0;
  bool config_due = true;

  // The rest belongs to the streaming thread.
  std::optional<lidar::rtp::StreamConfig> config;
  std::vector<std::uint8_t> config_bytes;
  std::uint8_t config_id = 0;
  GstClockTime config_sent_at = GST_CLOCK_TIME_NONE;
  lidar::rtp::ScanCounter scans{g_random_int()};
  std::optional<std::uint32_t> last_scan;
  guint unnamed_scans = 0;  // ids of buffers without a meta
  lidar::rtp::Aggregator aggregator;
  Slice first_aggregated;

  GstPadQueryFunction base_src_query = nullptr;
};

}  // namespace

struct _GstLidarRtpPay {
  GstRTPBasePayload parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarRtpPay, gst_lidar_rtp_pay, GST_TYPE_RTP_BASE_PAYLOAD)
GST_ELEMENT_REGISTER_DEFINE(rtplidarpay, "rtplidarpay", GST_RANK_SECONDARY, GST_TYPE_LIDAR_RTP_PAY)

static GstStaticPadTemplate sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS,
    GST_STATIC_CAPS(GST_LIDAR_DRACO_MEDIA_TYPE ", alignment = (string) slice, "
                                               "geometry = (string) { xyz, range }"));
static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS,
    GST_STATIC_CAPS("application/x-rtp, media = (string) application, payload = (int) [ 96, 127 ], "
                    "clock-rate = (int) 90000, encoding-name = (string) X-LIDAR-DRACO"));

namespace {

std::size_t MaxPayload(GstRTPBasePayload* base) {
  return gst_rtp_buffer_calc_payload_len(GST_RTP_BASE_PAYLOAD_MTU(base), 0, 0);
}

/// An RTP buffer of `packet`, whose body is a part of `slice_buffer` that is not copied.
GstBuffer* MakeBuffer(GstRTPBasePayload* base, const lidar::rtp::Packet& packet,
                      GstBuffer* slice_buffer) {
  GstBuffer* out = gst_rtp_base_payload_allocate_output_buffer(
      base, static_cast<guint>(packet.header.size()), 0, 0);
  GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
  gst_rtp_buffer_map(out, GST_MAP_WRITE, &rtp);
  memcpy(gst_rtp_buffer_get_payload(&rtp), packet.header.data(), packet.header.size());
  gst_rtp_buffer_set_marker(&rtp, packet.marker);
  gst_rtp_buffer_unmap(&rtp);
  if (packet.marker) GST_BUFFER_FLAG_SET(out, GST_BUFFER_FLAG_MARKER);
  if (packet.body_size > 0) {
    out = gst_buffer_append(out, gst_buffer_copy_region(slice_buffer, GST_BUFFER_COPY_MEMORY,
                                                        packet.body_offset, packet.body_size));
  }
  return out;
}

/// Appends `packets`; every one says which slice it is of, so that a sender can drop whole scans.
void Append(GstRTPBasePayload* base, const std::vector<lidar::rtp::Packet>& packets,
            const Slice& slice, GstBuffer* body, GstBufferList* list) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  for (const auto& packet : packets) {
    GstBuffer* out = MakeBuffer(base, packet, body);
    GST_BUFFER_PTS(out) = slice.pts;
    GST_BUFFER_DURATION(out) = slice.duration;
    gst_lidar_buffer_set_slice(out, &slice.meta);
    gst_buffer_list_add(list, out);
    std::lock_guard lock(state.mutex);
    ++state.counters.packets;
    const auto bytes = packet.header.size() + packet.body_size;
    state.counters.payload_bytes += bytes;
    state.recent_payload_bytes += static_cast<gdouble>(bytes);
  }
}

bool ConfigIsDue(State& state, GstClockTime pts) {
  std::lock_guard lock(state.mutex);
  const GstClockTime interval = state.settings.config_interval_s * GST_SECOND;
  const GstClockTime last = state.config_sent_at;
  const bool repeat =
      interval > 0 && (!GST_CLOCK_TIME_IS_VALID(pts) || !GST_CLOCK_TIME_IS_VALID(last) ||
                       pts < last || pts - last >= interval);
  if (!state.config_due && !repeat) return false;
  state.config_due = false;
  state.config_sent_at = pts;
  ++state.counters.configs;
  return true;
}

void AppendConfig(GstRTPBasePayload* base, const Slice& slice, GstBufferList* list) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  lidar::rtp::Unit unit;
  unit.unit = lidar::rtp::UnitType::kStreamConfig;
  unit.config_id = state.config_id;
  const lidar::ByteView bytes{state.config_bytes.data(), state.config_bytes.size()};
  const BufferPtr body(gst_buffer_new_memdup(bytes.data, bytes.size));
  Append(base, lidar::rtp::Packetize(unit, bytes, MaxPayload(base)), slice, body.get(), list);
}

GstFlowReturn PushList(GstRTPBasePayload* base, BufferListPtr list) {
  if (gst_buffer_list_length(list.get()) == 0) return GST_FLOW_OK;
  return gst_rtp_base_payload_push_list(base, list.release());
}

GstFlowReturn PushAggregate(GstRTPBasePayload* base) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  const auto packet = state.aggregator.Take();
  if (!packet) return GST_FLOW_OK;
  BufferListPtr list(gst_buffer_list_new());
  if (ConfigIsDue(state, state.first_aggregated.pts))
    AppendConfig(base, state.first_aggregated, list.get());
  Append(base, {*packet}, state.first_aggregated, nullptr, list.get());
  return PushList(base, std::move(list));
}

/// None, and an error posted, where the buffer's meta cannot be sent.
std::optional<Slice> DescribeSlice(GstRTPBasePayload* base, GstBuffer* buffer) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  Slice slice;
  if (!gst_lidar_buffer_get_slice(buffer, &slice.meta)) slice.meta.scan_id = state.unnamed_scans++;
  if (slice.meta.slice_count > lidar::rtp::kMaxSlicesPerScan ||
      slice.meta.slice_index >= slice.meta.slice_count || slice.meta.first_column > G_MAXUINT16) {
    GST_ELEMENT_ERROR(base, STREAM, FORMAT,
                      ("The LidarSliceMeta of a buffer is out of range: slice %u of %u, column %u.",
                       slice.meta.slice_index, slice.meta.slice_count, slice.meta.first_column),
                      ("at most %u slices a scan", lidar::rtp::kMaxSlicesPerScan));
    return std::nullopt;
  }
  slice.pts = GST_BUFFER_PTS(buffer);
  slice.duration = GST_BUFFER_DURATION(buffer);
  slice.unit.config_id = state.config_id;
  slice.unit.slice.index = static_cast<std::uint16_t>(slice.meta.slice_index);
  slice.unit.slice.count = static_cast<std::uint16_t>(slice.meta.slice_count);
  slice.unit.slice.scan_number = state.scans.Next(slice.meta.scan_id, slice.unit.slice.index);
  slice.unit.info.scan_id = slice.meta.scan_id;
  slice.unit.info.first_column = static_cast<std::uint16_t>(slice.meta.first_column);
  if (slice.duration < lidar::rtp::SliceInfo::kUnknownDuration)
    slice.unit.info.duration_ns = static_cast<std::uint32_t>(slice.duration);
  const GstClockTime capture = gst_lidar_buffer_get_capture_time(buffer);
  if (GST_CLOCK_TIME_IS_VALID(capture)) slice.unit.info.capture_ntp = lidar::rtp::ToNtp(capture);
  return slice;
}

void CountSlice(State& state, const Slice& slice, gsize size) {
  std::lock_guard lock(state.mutex);
  ++state.counters.slices;
  if (state.last_scan != slice.unit.slice.scan_number) ++state.counters.scans;
  state.last_scan = slice.unit.slice.scan_number;
  state.counters.slice_bytes += size;
  state.recent_slice_bytes = state.recent_slice_bytes * kShareMemory + static_cast<gdouble>(size);
  state.recent_payload_bytes *= kShareMemory;
}

/// Takes the slice into the packet that is being collected; false where it must go out alone.
bool Aggregate(GstRTPBasePayload* base, const Slice& slice, lidar::ByteView bytes,
               GstFlowReturn* flow) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  const auto ticks = GST_CLOCK_TIME_IS_VALID(slice.pts)
                         ? gst_util_uint64_scale(slice.pts, kClockRate, GST_SECOND)
                         : 0;
  for (int attempt = 0; attempt < 2; ++attempt) {
    const bool starts = state.aggregator.empty();
    if (state.aggregator.Add(slice.unit, bytes, MaxPayload(base), ticks)) {
      if (starts) state.first_aggregated = slice;
      const GstClockTime held = slice.pts + slice.duration - state.first_aggregated.pts;
      const bool scan_ends = slice.unit.slice.index + 1 == slice.unit.slice.count;
      if (scan_ends || gst_rtp_base_payload_is_filled(base, 0, held)) *flow = PushAggregate(base);
      return true;
    }
    *flow = PushAggregate(base);
    if (*flow != GST_FLOW_OK) return true;
  }
  return false;
}

bool MtuSuffices(GstRTPBasePayload* base) {
  if (MaxPayload(base) >= lidar::rtp::kMinPayload) return true;
  GST_ELEMENT_ERROR(base, RESOURCE, SETTINGS,
                    ("mtu is too small; set it to %u or more.",
                     gst_rtp_buffer_calc_packet_len(lidar::rtp::kMinPayload, 0, 0)),
                    (nullptr));
  return false;
}

}  // namespace

static GstFlowReturn gst_lidar_rtp_pay_handle_buffer(GstRTPBasePayload* base, GstBuffer* buffer) {
  const BufferPtr owner(buffer);
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  const BufferMap map(buffer, GST_MAP_READ);
  if (!map || map.size() > lidar::rtp::kMaxUnitBytes) {
    GST_ELEMENT_ERROR(base, STREAM, FORMAT,
                      ("A slice of %" G_GSIZE_FORMAT " bytes cannot be sent.", map.size()),
                      ("at most %" G_GSIZE_FORMAT " bytes", lidar::rtp::kMaxUnitBytes));
    return GST_FLOW_ERROR;
  }
  if (map.size() == 0) {
    std::lock_guard lock(state.mutex);
    ++state.counters.empty;
    return GST_FLOW_OK;
  }
  if (!MtuSuffices(base)) return GST_FLOW_ERROR;
  const auto slice = DescribeSlice(base, buffer);
  if (!slice) return GST_FLOW_ERROR;
  CountSlice(state, *slice, map.size());
  bool aggregate = false;
  {
    std::lock_guard lock(state.mutex);
    aggregate = state.settings.aggregate;
  }
  GstFlowReturn flow = GST_FLOW_OK;
  if (aggregate && Aggregate(base, *slice, map.view(), &flow)) return flow;
  flow = PushAggregate(base);  // left over from before `aggregate` was turned off
  if (flow != GST_FLOW_OK) return flow;
  BufferListPtr list(gst_buffer_list_new());
  if (ConfigIsDue(state, slice->pts)) AppendConfig(base, *slice, list.get());
  Append(base, lidar::rtp::Packetize(slice->unit, map.view(), MaxPayload(base)), *slice, buffer,
         list.get());
  return PushList(base, std::move(list));
}

static gboolean gst_lidar_rtp_pay_set_caps(GstRTPBasePayload* base, GstCaps* caps) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  auto config = lidar::gst::StreamConfigFromCaps(caps);
  if (!config) {
    GST_ELEMENT_ERROR(base, STREAM, FORMAT,
                      ("The caps do not describe an encoded cloud that can be sent."),
                      ("need fields, and a sensor-model with geometry=range: %" GST_PTR_FORMAT,
                       static_cast<void*>(caps)));
    return FALSE;
  }
  PushAggregate(base);
  if (state.config != config) {
    const bool first = !state.config.has_value();
    state.config = std::move(config);
    state.config_bytes = state.config->Serialise();
    state.config_id = lidar::rtp::ConfigId(
        state.config_bytes, first ? std::nullopt : std::optional<std::uint8_t>(state.config_id));
    std::lock_guard lock(state.mutex);
    state.config_due = true;
  }
  gst_rtp_base_payload_set_options(base, "application", TRUE, "X-LIDAR-DRACO", kClockRate);
  return gst_rtp_base_payload_set_outcaps(base, nullptr);
}

static gboolean gst_lidar_rtp_pay_sink_event(GstRTPBasePayload* base, GstEvent* event) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_EOS:
    case GST_EVENT_SEGMENT:
      PushAggregate(base);
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

namespace {

/// The part of the RTP payload that is the encoder's.
gdouble SliceShare(GstRTPBasePayload* base) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  std::lock_guard lock(state.mutex);
  if (state.recent_slice_bytes > 0 && state.recent_payload_bytes > 0)
    return MIN(1.0, state.recent_slice_bytes / state.recent_payload_bytes);
  const auto payload = static_cast<gdouble>(MaxPayload(base));
  const auto header = static_cast<gdouble>(lidar::rtp::HeaderSize(
      lidar::rtp::PacketType::kMiddleFragment, lidar::rtp::UnitType::kSlice));
  return MAX(0.5, 1 - header / payload);
}

/// The event as the encoder should see it: without what our headers take. Foreign fields stay.
GstEvent* WithoutHeaders(GstEvent* event, gdouble share) {
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

/// A receiver asked for a start point, or the SSRC will change: it needs the config at once.
bool WantsConfig(GstEvent* event) {
  return GST_EVENT_TYPE(event) == GST_EVENT_CUSTOM_UPSTREAM &&
         (gst_event_has_name(event, "GstForceKeyUnit") ||
          gst_event_has_name(event, "GstRTPCollision"));
}

}  // namespace

static gboolean gst_lidar_rtp_pay_src_event(GstRTPBasePayload* base, GstEvent* event) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  GstLidarTargetBitrate target{};
  if (gst_lidar_event_parse_target_bitrate(event, &target)) {
    GstEvent* out = WithoutHeaders(event, SliceShare(base));
    gst_event_unref(event);
    event = out;
  } else if (WantsConfig(event)) {
    std::lock_guard lock(state.mutex);
    state.config_due = true;
  }
  return GST_RTP_BASE_PAYLOAD_CLASS(gst_lidar_rtp_pay_parent_class)->src_event(base, event);
}

/// How long an aggregate may be held back; 0 where none is.
static GstClockTime HoldTime(GstRTPBasePayload* base) {
  State& state = *GST_LIDAR_RTP_PAY(base)->state;
  const CapsPtr caps(gst_pad_get_current_caps(GST_RTP_BASE_PAYLOAD_SINKPAD(base)));
  std::lock_guard lock(state.mutex);
  gint n = 0;
  gint d = 1;
  if (!state.settings.aggregate || !caps ||
      !gst_structure_get_fraction(gst_caps_get_structure(caps.get(), 0), "framerate", &n, &d) ||
      n <= 0) {
    return 0;
  }
  const GstClockTime scan = gst_util_uint64_scale_int(GST_SECOND, d, n);
  return base->max_ptime >= 0 ? MIN(scan, static_cast<GstClockTime>(base->max_ptime)) : scan;
}

static gboolean gst_lidar_rtp_pay_src_query(GstPad* pad, GstObject* parent, GstQuery* query) {
  if (!GST_LIDAR_RTP_PAY(parent)->state->base_src_query(pad, parent, query)) return FALSE;
  if (GST_QUERY_TYPE(query) != GST_QUERY_LATENCY) return TRUE;
  gboolean live = FALSE;
  GstClockTime min = 0;
  GstClockTime max = 0;
  gst_query_parse_latency(query, &live, &min, &max);
  const GstClockTime held = HoldTime(GST_RTP_BASE_PAYLOAD(parent));
  gst_query_set_latency(query, live, min + held,
                        GST_CLOCK_TIME_IS_VALID(max) ? max + held : GST_CLOCK_TIME_NONE);
  return TRUE;
}

static GstStateChangeReturn gst_lidar_rtp_pay_change_state(GstElement* element,
                                                           GstStateChange transition) {
  State& state = *GST_LIDAR_RTP_PAY(element)->state;
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    std::lock_guard lock(state.mutex);
    state.counters = {};
    state.recent_slice_bytes = state.recent_payload_bytes = 0;
    state.config_due = true;
    state.config.reset();
    state.config_sent_at = GST_CLOCK_TIME_NONE;
    state.scans = lidar::rtp::ScanCounter(g_random_int());
    state.last_scan.reset();
    state.unnamed_scans = 0;
    state.aggregator = {};
  }
  return GST_ELEMENT_CLASS(gst_lidar_rtp_pay_parent_class)->change_state(element, transition);
}

static GstStructure* Stats(GObject* object) {
  State& state = *GST_LIDAR_RTP_PAY(object)->state;
  GstStructure* s = lidar::gst::BaseClassStats(object, gst_lidar_rtp_pay_parent_class);
  std::lock_guard lock(state.mutex);
  const Counters& c = state.counters;
  gst_structure_set(s, "scans-sent", G_TYPE_UINT64, c.scans, "slices-sent", G_TYPE_UINT64, c.slices,
                    "packets-sent", G_TYPE_UINT64, c.packets, "configs-sent", G_TYPE_UINT64,
                    c.configs, "slice-bytes", G_TYPE_UINT64, c.slice_bytes, "payload-bytes",
                    G_TYPE_UINT64, c.payload_bytes, "empty-dropped", G_TYPE_UINT64, c.empty,
                    nullptr);
  return s;
}

static void gst_lidar_rtp_pay_init(GstLidarRtpPay* self) {
  self->state = new State;
  GstPad* src = GST_RTP_BASE_PAYLOAD_SRCPAD(self);
  self->state->base_src_query = GST_PAD_QUERYFUNC(src);
  gst_pad_set_query_function(src, gst_lidar_rtp_pay_src_query);
}

static void InstallGObject(GObjectClass* object) {
  object->set_property = [](GObject* o, guint id, const GValue* v, GParamSpec*) {
    State& s = *GST_LIDAR_RTP_PAY(o)->state;
    std::lock_guard lock(s.mutex);
    lidar::gst::SetProperty(s.settings, kProperties[id - 1], v);
  };
  object->get_property = [](GObject* o, guint id, GValue* v, GParamSpec*) {
    if (id == kStatsId) {
      g_value_take_boxed(v, Stats(o));
      return;
    }
    State& s = *GST_LIDAR_RTP_PAY(o)->state;
    std::lock_guard lock(s.mutex);
    lidar::gst::GetProperty(s.settings, kProperties[id - 1], v);
  };
  object->finalize = [](GObject* o) {
    delete GST_LIDAR_RTP_PAY(o)->state;
    G_OBJECT_CLASS(gst_lidar_rtp_pay_parent_class)->finalize(o);
  };
  lidar::gst::InstallProperties(object, kProperties);
  g_object_class_install_property(
      object, kStatsId,
      g_param_spec_boxed(
          "stats", "stats", "What was sent, beside the fields that every RTP payloader has",
          GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
}

static void gst_lidar_rtp_pay_class_init(GstLidarRtpPayClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_rtp_pay_debug, "rtplidarpay", 0, "RTP payloader for clouds");
  InstallGObject(G_OBJECT_CLASS(klass));
  auto* element = GST_ELEMENT_CLASS(klass);
  gst_element_class_add_static_pad_template(element, &sink_template);
  gst_element_class_add_static_pad_template(element, &src_template);
  gst_element_class_set_static_metadata(element, "RTP payloader for point clouds",
                                        "Codec/Payloader/Network/RTP",
                                        "Sends slices of encoded clouds as RTP", "gst-lidar");
  element->change_state = gst_lidar_rtp_pay_change_state;
  auto* pay = GST_RTP_BASE_PAYLOAD_CLASS(klass);
  pay->set_caps = gst_lidar_rtp_pay_set_caps;
  pay->handle_buffer = gst_lidar_rtp_pay_handle_buffer;
  pay->sink_event = gst_lidar_rtp_pay_sink_event;
  pay->src_event = gst_lidar_rtp_pay_src_event;
}
