// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-screamrx
 *
 * Passes RTP on unchanged and reports on rtcp_src what arrived, when and with which ECN bits, as
 * the SCReAM sender needs it (RFC 8888).
 *
 * |[
 * gst-launch-1.0 ecnudpsrc port=5004 ! screamrx name=rx ! fakesink \
 *   rx.rtcp_src ! ecnudpsink host=127.0.0.1 port=5005 sync=false async=false
 * ]|
 */
#include "gst/scream/rx/gstscreamrx.h"

#include "gst/common/element_class.h"
#include "gst/common/enum_type.h"
#include "gst/common/sink_pads.h"
#include "gst/common/stats.h"
#include "gst/scream/rx/private.h"

GST_DEBUG_CATEGORY(gst_lidar_scream_rx_debug);
#define GST_CAT_DEFAULT gst_lidar_scream_rx_debug

using namespace lidar::gst;

G_DEFINE_TYPE(GstLidarScreamRx, gst_lidar_scream_rx, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(screamrx, "screamrx", GST_RANK_NONE, GST_TYPE_LIDAR_SCREAM_RX)

namespace lidar::gst {

GType NumReportsType() {
  static const GEnumValue values[] = {
      {kNumReportsCount, "Number of blocks (RFC 8888 with erratum 8166)", "count"},
      {kNumReportsEricsson, "One less, as Ericsson's SCReAM reads it", "ericsson"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarScreamNumReports", values);
  return type;
}

/// The values that the property stats shows.
struct Shown {
  rtcp::FeedbackGenerator::Stats feedback;
  RxCounters own;
};
template <auto field>
constexpr auto F = At<&Shown::feedback, field>;
template <auto field>
constexpr auto O = At<&Shown::own, field>;

/// Adds the packet counters of each link of the peer to `stats`.
static void AddLinkStats(const LinkReports& reports, GstStructure* stats) {
  using S = LinkReports::LinkStats;
  using G = rtcp::FeedbackGenerator::Stats;
  static const std::array<Stat<S>, 4> kStats = {{
      {"address", &S::address},
      {"packets-received", At<&S::feedback, &G::packets>},
      {"bytes-received", At<&S::feedback, &G::received>},
      {"packets-ce", At<&S::feedback, &G::ce_packets>},
  }};
  GValue links = G_VALUE_INIT;
  gst_value_array_init(&links, 0);
  for (const S& link : reports.stats()) {
    GValue value = G_VALUE_INIT;
    g_value_init(&value, GST_TYPE_STRUCTURE);
    g_value_take_boxed(&value, ToStructure("link", kStats, link).release());
    gst_value_array_append_and_take_value(&links, &value);
  }
  gst_structure_take_value(stats, "links", &links);
}

static StructurePtr Stats(GObject* object) {
  using S = rtcp::FeedbackGenerator::Stats;
  using C = RxCounters;
  static const std::array<Stat<Shown>, 16> kStats = {{
      {"packets-received", F<&S::packets>},
      {"bytes-received", F<&S::received>},
      {"packets-ce", F<&S::ce_packets>},
      {"packets-lost", F<&S::lost>},
      {"packets-reordered", F<&S::reordered>},
      {"packets-duplicate", F<&S::duplicates>},
      {"packets-copies", O<&C::copies>},
      {"packets-stale", F<&S::stale>},
      {"packets-foreign", O<&C::foreign>},
      {"malformed", O<&C::malformed>},
      {"packets-old", O<&C::old>},
      {"reports-sent", F<&S::reports>},
      {"report-bytes", F<&S::sent>},
      {"peer-moves", O<&C::moves>},
      {"goodbyes", O<&C::goodbyes>},
      {"ssrcs", O<&C::ssrcs>},
  }};
  RxState& state = *GST_LIDAR_SCREAM_RX(object)->state;
  const RxLock lock(state.mutex);
  Shown shown{state.reports.Sum(), state.counters};
  shown.own.ssrcs = static_cast<guint>(state.ssrcs.size());
  StructurePtr stats = ToStructure("application/x-screamrx-stats", kStats, shown);
  if (state.latch.links() > 1) AddLinkStats(state.reports, stats.get());
  state.sender.AddStats(state.clock != nullptr ? RxNow(state) : Time{}, stats.get());
  return stats;
}

const RxProperties& RxPropertyTable() {
  using S = RxSettings;
  using C = rtcp::FeedbackConfig;
  constexpr gint kLive = GST_PARAM_MUTABLE_PLAYING;
  static const RxProperties table = {{
      {"feedback-interval", "Longest time from a packet to its report; shorter at high rates [ns]",
       At<&S::feedback, &C::feedback_interval>, 1e6, 10e9, kLive},
      {"packets-per-feedback", "A report is sent after this many packets", &S::packets_per_feedback,
       1, 1000, kLive},
      {"ssrc", "SSRC of the reports; 0 for a random one", &S::ssrc, 0, 4294967295.0},
      {"num-reports", "Meaning of num_reports in the reports",
       EnumField<S>{&S::num_reports, NumReportsType}, 0, 0, kLive},
      {"feedback-on-marker", "Report at the end of each frame or slice",
       At<&S::feedback, &C::report_on_marker>, 0, 0, kLive},
      {"eos-on-bye", "End the stream once every SSRC has sent BYE", &S::eos_on_bye, 0, 0, kLive},
      {"packet-overhead", "UDP and IP header of a packet on the wire [bytes]", &S::packet_overhead,
       0, 1000, kLive},
      {"max-age",
       "Drop LiDAR data whose capture time differs more than this from this machine's clock; 0: "
       "drop none [ns]",
       &S::max_age, 0, static_cast<gdouble>(G_MAXINT64), kLive},
      {"pt-map",
       "Caps of each payload type (application/x-rtp-pt-map,96=(string)\"...\"); with it each of "
       "several streams leaves by a pad of its own",
       &S::pt_map},
      {"stats", "Counters of packets, bytes and reports", Stats},
  }};
  return table;
}

Time RxNow(const RxState& state) {
  return Time{Duration{static_cast<std::int64_t>(gst_clock_get_time(state.clock))}};
}

rtcp::FeedbackConfig ToConfig(const RxSettings& s, guint32 own_ssrc) {
  rtcp::FeedbackConfig config = s.feedback;
  config.sender_ssrc = own_ssrc;
  config.packets_per_feedback = static_cast<int>(s.packets_per_feedback);
  return config;
}

}  // namespace lidar::gst

static RxState& StateOf(gpointer self) { return *GST_LIDAR_SCREAM_RX(self)->state; }

static gboolean SinkEvent(GstPad*, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_SCREAM_RX(parent);
  RxState& state = *self->state;
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_EOS:
      if (state.eos) {  // RTCP BYEs have already ended the stream
        gst_event_unref(event);
        return TRUE;
      }
      break;
    case GST_EVENT_STREAM_START:  // the other pads have their own STREAM_START
      return gst_pad_push_event(self->src, event);
    case GST_EVENT_FLUSH_STOP:
      state.eos = false;
      break;
    case GST_EVENT_CAPS:
      if (!HasPtMap(self)) {
        GstCaps* caps = nullptr;
        gst_event_parse_caps(event, &caps);
        NoteCaps(state, caps);
        break;
      }
      gst_event_unref(event);  // pt-map has the caps of each stream
      return TRUE;
    default:
      break;
  }
  return ForwardToAll(self, event);
}

static GstIterator* LinksOf(GstPad* pad, GstObject* parent) {
  auto* self = GST_LIDAR_SCREAM_RX(parent);
  if (pad == self->rtcp_src) return nullptr;
  return LinkTo(pad == self->sink ? self->src : self->sink);
}

static gboolean SinkQuery(GstPad* pad, GstObject* parent, GstQuery* query) {
  auto* self = GST_LIDAR_SCREAM_RX(parent);
  if (GST_QUERY_TYPE(query) == GST_QUERY_CAPS && HasPtMap(self)) {
    const CapsPtr caps(gst_pad_get_pad_template_caps(pad));
    gst_query_set_caps_result(query, caps.get());
    return TRUE;
  }
  return gst_pad_query_default(pad, parent, query);
}

static void Prepare(RxState& state) {
  RxLock lock(state.mutex);
  if (state.clock == nullptr) state.clock = gst_system_clock_obtain();
  state.own_ssrc = state.settings.ssrc != 0 ? state.settings.ssrc : g_random_int() | 1;
  state.reports.Reset(ToConfig(state.settings, state.own_ssrc));
  state.latch.Restart();
  state.seen = {};
  NoteLidarTypes(state);
  state.ssrcs.clear();
  state.key_requests.clear();
  state.old_streams.clear();
  state.counters = {};
  state.sender.Reset();
  state.eos = false;
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange change) {
  auto* self = GST_LIDAR_SCREAM_RX(element);
  if (change == GST_STATE_CHANGE_READY_TO_PAUSED) {
    Prepare(*self->state);
    CheckPtMap(self);
  }
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_lidar_scream_rx_parent_class)->change_state(element, change);
  if (change == GST_STATE_CHANGE_PAUSED_TO_READY) {
    RemoveRoutes(self);
    gst_flow_combiner_reset(self->state->combiner);
  }
  return result;
}

static void SettingsChanged(GObject* object, GParamSpec*) {
  RxState& state = StateOf(object);
  const RxLock lock(state.mutex);
  state.settings_changed = true;
  if (state.timer != nullptr) gst_clock_id_unschedule(state.timer);
}

static GstPad* AddLinkedPad(GstLidarScreamRx* self, const char* name) {
  GstPad* pad = AddPad(self, name);
  gst_pad_set_iterate_internal_links_function(pad, LinksOf);
  return pad;
}

static void gst_lidar_scream_rx_init(GstLidarScreamRx* self) {
  self->state = new RxState;
  self->state->combiner = gst_flow_combiner_new();
  self->sink = AddLinkedPad(self, "sink");
  gst_pad_set_chain_function(self->sink, RxChain);
  gst_pad_set_chain_list_function(self->sink, RxChainList);
  gst_pad_set_event_function(self->sink, SinkEvent);
  gst_pad_set_query_function(self->sink, SinkQuery);
  GST_PAD_SET_PROXY_CAPS(self->sink);
  GST_PAD_SET_PROXY_ALLOCATION(self->sink);
  self->src = AddLinkedPad(self, "src");
  GST_PAD_SET_PROXY_CAPS(self->src);
  gst_pad_set_event_function(self->src, RxSrcEvent);
  gst_flow_combiner_add_pad(self->state->combiner, self->src);
  self->rtcp_src = AddLinkedPad(self, "rtcp_src");
  gst_pad_set_activatemode_function(self->rtcp_src, RxActivateRtcp);
}

static void Finalize(GObject* o) {
  auto* self = GST_LIDAR_SCREAM_RX(o);
  if (self->state->clock != nullptr) gst_object_unref(self->state->clock);
  gst_flow_combiner_free(self->state->combiner);
  delete self->state;
  G_OBJECT_CLASS(gst_lidar_scream_rx_parent_class)->finalize(o);
}

static void gst_lidar_scream_rx_class_init(GstLidarScreamRxClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_scream_rx_debug, "screamrx", 0, "SCReAM v2 receiver");
  auto* object = G_OBJECT_CLASS(klass);
  ServeProperties<GstLidarScreamRx, RxPropertyTable, SettingsChanged>(object);
  object->finalize = Finalize;
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
  Describe(klass,
           {"SCReAM receiver", "Filter/Network/RTP",
            "Congestion control feedback for RTP (RFC 8888) with ECN"},
           {{"sink", GST_PAD_SINK, "application/x-rtp"},
            {"src", GST_PAD_SRC, "application/x-rtp"},
            {"src_%u", GST_PAD_SRC, "application/x-rtp", GST_PAD_SOMETIMES},
            {"rtcp_src", GST_PAD_SRC, "application/x-rtcp"}});
}
