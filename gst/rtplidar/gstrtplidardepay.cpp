// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-rtplidardepay
 *
 * Puts RTP packets back together into slices of encoded clouds. A lost packet costs its slice
 * only; damaged slices are dropped, and everything that is missing is counted in `stats`.
 *
 * |[
 * gst-launch-1.0 udpsrc port=5004 \
 *   caps="application/x-rtp,media=application,clock-rate=90000,payload=96,\
 *   encoding-name=X-LIDAR-DRACO" \
 *   ! rtplidardepay ! lidardec ! fakesink
 * ]|
 */
#include <gst/rtp/gstrtpbasedepayload.h>

#include <gst/rtp/gstrtpbuffer.h>

#include <mutex>
#include <optional>
#include <utility>

#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/common/stats.h"
#include "gst/lidar/gstlidar.h"
#include "gst/rtplidar/base_stats.h"
#include "gst/rtplidar/slice_output.h"
#include "src/rtp/receiver.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_rtp_depay_debug);
#define GST_CAT_DEFAULT gst_lidar_rtp_depay_debug

using lidar::rtp::PacketAccounts;
using lidar::rtp::ReceivedSlice;
using lidar::rtp::Receiver;
using lidar::rtp::ReceiverAccounts;
using lidar::rtp::SliceAccounts;

namespace {

using namespace lidar::gst;

struct Settings {
  guint64 max_reorder_time = 100 * GST_MSECOND;
};

/// The values in `stats`.
struct Shown {
  ReceiverAccounts all;
  guint64 invalid = 0;
  guint64 wrong_payload_type = 0;
  guint64 not_accepted = 0;
  guint64 format_changes = 0;
};
template <auto field>
constexpr auto A = At<&Shown::all, field>;
template <auto field>
constexpr auto S = At<&Shown::all, &ReceiverAccounts::slices, field>;
template <auto field>
constexpr auto P = At<&Shown::all, &ReceiverAccounts::packets, field>;
const std::array<Stat<Shown>, 20> kStats = {{
    {"slices-received", S<&SliceAccounts::slices_received>},
    {"slices-lost", S<&SliceAccounts::slices_lost>},
    {"slices-damaged", S<&SliceAccounts::slices_damaged>},
    {"slices-config-mismatch", S<&SliceAccounts::slices_config_mismatch>},
    {"slices-skipped", S<&SliceAccounts::slices_skipped>},
    {"scans-complete", S<&SliceAccounts::scans_complete>},
    {"scans-incomplete", S<&SliceAccounts::scans_incomplete>},
    {"scans-lost", S<&SliceAccounts::scans_lost>},
    {"scans-skipped", S<&SliceAccounts::scans_skipped>},
    {"packets-received", A<&ReceiverAccounts::packets_received>},
    {"packets-invalid", &Shown::invalid},
    {"packets-wrong-payload-type", &Shown::wrong_payload_type},
    {"slices-not-accepted", &Shown::not_accepted},
    {"slices-changing-format", &Shown::format_changes},
    {"packets-duplicate", P<&PacketAccounts::duplicate>},
    {"packets-late", P<&PacketAccounts::late>},
    {"configs-received", A<&ReceiverAccounts::configs_received>},
    {"configs-damaged", P<&PacketAccounts::config_damaged>},
    {"sender-restarts", A<&ReceiverAccounts::restarts>},
    {"outages", A<&ReceiverAccounts::outages>},
}};

// The number of packets of another payload type after which a warning is posted, if no packet of
// the right type was received.
constexpr guint64 kWrongTypePackets = 20;
// The number of unreadable packets after which a warning is posted, if no packet was readable.
constexpr guint64 kUnreadablePackets = 20;

lidar::Duration ReorderTime(const Settings& s) {
  return lidar::Duration{static_cast<gint64>(s.max_reorder_time)};
}

struct State {
  explicit State(GstRTPBaseDepayload* self) : output(self) {}

  // Guards the members up to wrong_payload_type. It is never held while pushing.
  std::mutex mutex;
  Settings settings;
  Receiver receiver{ReorderTime(Settings{})};
  guint64 not_rtp = 0;
  guint64 wrong_payload_type = 0;

  // The members below are used by the streaming thread only.
  SliceOutput output;
  std::optional<gint> payload_type;  // payload type in the caps
  bool warned_of_type = false;
  bool warned_of_rival = false;
  bool readable = false;  // true after a readable packet, or after the warning
  // The largest PTS so far plus `shift`. It does not go back in a segment whose PTS start anew.
  lidar::Time now;
  lidar::Duration shift{0};  // added to a PTS to get `now`
  bool new_segment = false;
  GstPadChainFunction base_chain = nullptr;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarRtpDepay, gst_lidar_rtp_depay, GST_LIDAR, RTP_DEPAY,
                     GstRTPBaseDepayload)
struct _GstLidarRtpDepay {
  GstRTPBaseDepayload parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarRtpDepay, gst_lidar_rtp_depay, GST_TYPE_RTP_BASE_DEPAYLOAD)
GST_ELEMENT_REGISTER_DEFINE(rtplidardepay, "rtplidardepay", GST_RANK_SECONDARY,
                            gst_lidar_rtp_depay_get_type())

static StructurePtr Stats(GObject* object) {
  State& state = *GST_LIDAR_RTP_DEPAY(object)->state;
  auto stats = BaseClassStats(object, gst_lidar_rtp_depay_parent_class);
  std::lock_guard lock(state.mutex);
  const auto all = state.receiver.accounts();
  AddStats(stats.get(), kStats,
           {all, all.packets.invalid + state.not_rtp, state.wrong_payload_type,
            state.output.not_accepted(), state.output.format_changes()});
  return stats;
}

static const std::array<Property<Settings>, 2> kProperties = {{
    {"max-reorder-time",
     "Longest time that a slice waits for missing packets after a later slice began; other slices "
     "do not wait for it [ns]",
     &Settings::max_reorder_time, 0, 10.0 * GST_SECOND, GST_PARAM_MUTABLE_PLAYING},
    {"stats",
     "Counters of received and missing slices and scans, in addition to the fields of every RTP "
     "depayloader",
     Stats},
}};

/// Counts a packet of another payload type. Returns true if at least kWrongTypePackets of these
/// packets have arrived, but no packet of the right type.
static bool CountWrongType(State& state) {
  std::lock_guard lock(state.mutex);
  return ++state.wrong_payload_type >= kWrongTypePackets &&
         state.receiver.accounts().packets_received == 0;
}

/// Returns false for a buffer that is not RTP or has another payload type, and counts it. The base
/// class would post a warning for each of these buffers, which would flood the bus.
static bool IsOurs(GstLidarRtpDepay* self, GstBuffer* buffer) {
  State& state = *self->state;
  GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
  if (!gst_rtp_buffer_map(buffer, GST_MAP_READ, &rtp)) {
    std::lock_guard lock(state.mutex);
    ++state.not_rtp;
    return false;
  }
  const gint type = gst_rtp_buffer_get_payload_type(&rtp);
  gst_rtp_buffer_unmap(&rtp);
  if (!state.payload_type || *state.payload_type == type) return true;
  if (CountWrongType(state) && !std::exchange(state.warned_of_type, true)) {
    GST_ELEMENT_WARNING(self, STREAM, WRONG_TYPE,
                        ("The packets have payload type %d, not %d as the caps say: none of them "
                         "is decoded.",
                         type, *state.payload_type),
                        ("set payload=%d in the caps of the source, or pt=%d at the payloader",
                         type, *state.payload_type));
  }
  return false;
}

/// Warns of a second sender with the same payload type, but only once.
static void WarnOfRival(GstLidarRtpDepay* self, guint32 ssrc, guint32 rival) {
  if (std::exchange(self->state->warned_of_rival, true)) return;
  GST_ELEMENT_WARNING(self, STREAM, WRONG_TYPE,
                      ("Two streams arrive; the stream of SSRC %u is dropped.", rival),
                      ("rtplidardepay decodes one stream, SSRC %u; pt-map of screamsrc, or "
                       "rtpssrcdemux, gives each stream a pad of its own",
                       ssrc));
}

/// Returns true if kUnreadablePackets packets were invalid and none was readable, but only once.
/// The caller must hold the mutex.
static bool IsUnreadable(State& state) {
  if (state.readable) return false;
  const ReceiverAccounts all = state.receiver.accounts();
  const bool unreadable = all.packets.invalid >= kUnreadablePackets;
  state.readable = unreadable || all.slices.slices_received > 0 || all.configs_received > 0;
  return unreadable && all.slices.slices_received == 0 && all.configs_received == 0;
}

static GstFlowReturn Chain(GstPad* pad, GstObject* parent, GstBuffer* buffer) {
  auto* self = GST_LIDAR_RTP_DEPAY(parent);
  if (self->state->payload_type && !IsOurs(self, buffer)) {
    gst_buffer_unref(buffer);
    return GST_FLOW_OK;
  }
  return self->state->base_chain(pad, parent, buffer);
}

static GstFlowReturn ChainList(GstPad* pad, GstObject* parent, GstBufferList* list) {
  const BufferListPtr owner(list);
  GstFlowReturn flow = GST_FLOW_OK;
  for (guint i = 0; i < gst_buffer_list_length(list) && flow == GST_FLOW_OK; ++i)
    flow = Chain(pad, parent, gst_buffer_ref(gst_buffer_list_get(list, i)));
  return flow;
}

/// Advances `now` to the time of `pts`.
static void Advance(State& state, lidar::Time pts) {
  if (std::exchange(state.new_segment, false)) state.shift = std::max(state.shift, state.now - pts);
  state.now = std::max(state.now, pts + state.shift);
}

static void ResetTime(State& state) {
  state.output.ResetTime();
  state.now = {};
  state.shift = {};
}

static GstBuffer* Process(GstRTPBaseDepayload* base, GstRTPBuffer* rtp) {
  State& state = *GST_LIDAR_RTP_DEPAY(base)->state;
  const GstClockTime pts = GST_BUFFER_PTS(rtp->buffer);
  lidar::rtp::RtpPacket packet;
  packet.ssrc = gst_rtp_buffer_get_ssrc(rtp);
  packet.sequence = gst_rtp_buffer_get_seq(rtp);
  packet.payload = {static_cast<const std::uint8_t*>(gst_rtp_buffer_get_payload(rtp)),
                    gst_rtp_buffer_get_payload_len(rtp)};
  if (GST_CLOCK_TIME_IS_VALID(pts)) {
    packet.pts = lidar::Time{lidar::Duration{static_cast<gint64>(pts)}};
    Advance(state, *packet.pts);
  }
  packet.arrival = state.now;
  std::vector<ReceivedSlice> slices;
  std::optional<std::uint32_t> rival;
  bool unreadable = false;
  {
    std::lock_guard lock(state.mutex);
    slices = state.receiver.Push(packet);
    rival = state.receiver.rival();
    unreadable = IsUnreadable(state);
  }
  if (unreadable)
    GST_ELEMENT_WARNING(
        base, STREAM, DECODE,
        ("None of the packets can be read: they are not a LiDAR stream, or they are encrypted. If "
         "the sender has an srtp-key, set the same key at screamsrc."),
        (nullptr));
  if (rival && *rival == packet.ssrc)
    WarnOfRival(GST_LIDAR_RTP_DEPAY(base), *state.receiver.ssrc(), *rival);
  state.output.Push(std::move(slices), state.now);
  return nullptr;
}

static gboolean SetCaps(GstRTPBaseDepayload* base, GstCaps* caps) {
  State& state = *GST_LIDAR_RTP_DEPAY(base)->state;
  gint type = 0;
  state.payload_type.reset();
  if (gst_structure_get_int(gst_caps_get_structure(caps, 0), "payload", &type))
    state.payload_type = type;
  base->clock_rate = 90'000;
  return TRUE;
}

static gboolean HandleEvent(GstRTPBaseDepayload* base, GstEvent* event) {
  State& state = *GST_LIDAR_RTP_DEPAY(base)->state;
  if (GST_EVENT_TYPE(event) == GST_EVENT_EOS || GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) {
    std::lock_guard lock(state.mutex);
    state.receiver.Finish();
    ResetTime(state);
  }
  if (GST_EVENT_TYPE(event) == GST_EVENT_SEGMENT) state.new_segment = true;
  return GST_RTP_BASE_DEPAYLOAD_CLASS(gst_lidar_rtp_depay_parent_class)->handle_event(base, event);
}

/// Ignores the event of a jitterbuffer about a lost packet, because this element counts lost slices
/// itself.
static gboolean PacketLost(GstRTPBaseDepayload*, GstEvent*) { return TRUE; }

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  State& state = *GST_LIDAR_RTP_DEPAY(element)->state;
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    std::lock_guard lock(state.mutex);
    state.receiver = Receiver(ReorderTime(state.settings));
    state.not_rtp = state.wrong_payload_type = 0;
    state.warned_of_type = state.warned_of_rival = state.readable = false;
    state.payload_type.reset();
    state.output.Reset();
    ResetTime(state);
  }
  const auto result =
      GST_ELEMENT_CLASS(gst_lidar_rtp_depay_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    std::lock_guard lock(state.mutex);
    state.receiver.Finish();
  }
  return result;
}

static void TakeReorderTime(GObject* object, GParamSpec*) {
  State& state = *GST_LIDAR_RTP_DEPAY(object)->state;
  std::lock_guard lock(state.mutex);
  state.receiver.set_max_reorder_time(ReorderTime(state.settings));
}

static void gst_lidar_rtp_depay_init(GstLidarRtpDepay* self) {
  self->state = new State(GST_RTP_BASE_DEPAYLOAD(self));
  GstPad* sink = GST_RTP_BASE_DEPAYLOAD_SINKPAD(self);
  self->state->base_chain = GST_PAD_CHAINFUNC(sink);
  gst_pad_set_chain_function(sink, Chain);
  gst_pad_set_chain_list_function(sink, ChainList);
  // The base class must pass packets in any order, because this element reorders them itself.
  g_object_set(self, "max-reorder", 0, nullptr);
}

static void gst_lidar_rtp_depay_class_init(GstLidarRtpDepayClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_rtp_depay_debug, "rtplidardepay", 0,
                          "RTP depayloader for clouds");
  ServeState<GstLidarRtpDepay, gst_lidar_rtp_depay_parent_class, kProperties, TakeReorderTime>(
      klass);
  auto* element = GST_ELEMENT_CLASS(klass);
  Describe(klass,
           {"RTP depayloader for point clouds", "Codec/Depayloader/Network/RTP",
            "Gets slices of encoded clouds out of RTP"},
           {{"sink", GST_PAD_SINK,
             "application/x-rtp, media = (string) { application, video }, "
             "payload = (int) [ 96, 127 ], "
             "clock-rate = (int) 90000, encoding-name = (string) X-LIDAR-DRACO"},
            {"src", GST_PAD_SRC, "ANY"}});
  element->change_state = ChangeState;
  auto* depay = GST_RTP_BASE_DEPAYLOAD_CLASS(klass);
  depay->set_caps = SetCaps;
  depay->process_rtp_packet = Process;
  depay->handle_event = HandleEvent;
  depay->packet_lost = PacketLost;
}
