// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-screamrx
 *
 * Passes RTP on unchanged and reports on rtcp_src what arrived, when and with which ECN bits, as
 * the SCReAM sender needs it (RFC 8888).
 *
 * |[
 * gst-launch-1.0 ecnudpsrc port=5004 ! screamrx name=rx ! fakesink  rx.rtcp_src ! ecnudpsink
 * host=127.0.0.1 port=5005 sync=false async=false
 * ]|
 */
#include "gst/scream/rx/gstscreamrx.h"

#include "gst/scream/rx/private.h"

GST_DEBUG_CATEGORY(gst_lidar_scream_rx_debug);
#define GST_CAT_DEFAULT gst_lidar_scream_rx_debug

using namespace lidar::gst;

G_DEFINE_TYPE(GstLidarScreamRx, gst_lidar_scream_rx, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(screamrx, "screamrx", GST_RANK_NONE, GST_TYPE_LIDAR_SCREAM_RX)

static GstStaticPadTemplate sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS("application/x-rtp"));
static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("application/x-rtp"));
static GstStaticPadTemplate stream_template = GST_STATIC_PAD_TEMPLATE(
    "src_%u", GST_PAD_SRC, GST_PAD_SOMETIMES, GST_STATIC_CAPS("application/x-rtp"));
static GstStaticPadTemplate rtcp_template = GST_STATIC_PAD_TEMPLATE(
    "rtcp_src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("application/x-rtcp"));

static const std::array<Property<RxSettings>, 7> kProperties = {{
    {"feedback-interval", "Longest wait of a packet for its report; less at high rate [ns]",
     &RxSettings::feedback_interval, 1e6, 10e9, GST_PARAM_MUTABLE_PLAYING},
    {"packets-per-feedback", "A report is sent after this many packets",
     &RxSettings::packets_per_feedback, 1, 1000, GST_PARAM_MUTABLE_PLAYING},
    {"ssrc", "SSRC of the reports; 0 for a random one", &RxSettings::ssrc, 0, 4294967295.0},
    {"num-reports", "Meaning of num_reports in the reports",
     EnumField<RxSettings>{&RxSettings::num_reports, NumReportsType}, 0, 0,
     GST_PARAM_MUTABLE_PLAYING},
    {"feedback-on-marker", "Report at the end of each frame or slice",
     &RxSettings::feedback_on_marker, 0, 0, GST_PARAM_MUTABLE_PLAYING},
    {"eos-on-bye", "End the stream once every SSRC has said BYE", &RxSettings::eos_on_bye, 0, 0,
     GST_PARAM_MUTABLE_PLAYING},
    {"packet-overhead", "UDP and IP header of a packet on the wire [bytes]",
     &RxSettings::packet_overhead, 0, 1000, GST_PARAM_MUTABLE_PLAYING},
}};
enum : guint { kPropPtMap = kProperties.size() + 1, kPropStats };

namespace lidar::gst {

GType NumReportsType() {
  static gsize type = 0;
  if (g_once_init_enter(&type)) {
    static const GEnumValue values[] = {
        {kNumReportsCount, "Number of blocks (RFC 8888 with erratum 8166)", "count"},
        {kNumReportsEricsson, "One less, as Ericsson's SCReAM reads it", "ericsson"},
        {0, nullptr, nullptr}};
    g_once_init_leave(&type, g_enum_register_static("GstLidarScreamNumReports", values));
  }
  return type;
}

Time RxNow(const RxState& state) {
  return Time{Duration{static_cast<std::int64_t>(gst_clock_get_time(state.clock))}};
}

scream::FeedbackConfig ToConfig(const RxSettings& s, guint32 own_ssrc) {
  scream::FeedbackConfig config;
  config.sender_ssrc = own_ssrc;
  config.feedback_interval = Duration{static_cast<std::int64_t>(s.feedback_interval)};
  config.packets_per_feedback = static_cast<int>(s.packets_per_feedback);
  config.report_on_marker = s.feedback_on_marker;
  return config;
}

}  // namespace lidar::gst

static RxState& StateOf(gpointer self) { return *GST_LIDAR_SCREAM_RX(self)->state; }

static gboolean SinkEvent(GstPad*, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_SCREAM_RX(parent);
  RxState& state = *self->state;
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_EOS:
      if (state.eos) {  // said already, for the goodbyes
        gst_event_unref(event);
        return TRUE;
      }
      break;
    case GST_EVENT_STREAM_START:  // the other pads have their own
      return gst_pad_push_event(self->src, event);
    case GST_EVENT_FLUSH_STOP:
      state.eos = false;
      break;
    case GST_EVENT_CAPS:
      if (!HasPtMap(self)) break;
      gst_event_unref(event);  // pt-map says what each stream is
      return TRUE;
    default:
      break;
  }
  return ForwardToAll(self, event);
}

static GstIterator* LinksOf(GstPad* pad, GstObject* parent) {
  auto* self = GST_LIDAR_SCREAM_RX(parent);
  if (pad == self->rtcp_src) return nullptr;
  GValue value = G_VALUE_INIT;
  g_value_init(&value, GST_TYPE_PAD);
  g_value_set_object(&value, pad == self->sink ? self->src : self->sink);
  GstIterator* it = gst_iterator_new_single(GST_TYPE_PAD, &value);
  g_value_unset(&value);
  return it;
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
  state.generator = lidar::scream::FeedbackGenerator(ToConfig(state.settings, state.own_ssrc));
  state.latch.Reset();
  state.ssrcs.clear();
  state.foreign = state.malformed = state.moves = state.goodbyes = 0;
  state.eos = false;
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange change) {
  auto* self = GST_LIDAR_SCREAM_RX(element);
  if (change == GST_STATE_CHANGE_READY_TO_PAUSED) Prepare(*self->state);
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_lidar_scream_rx_parent_class)->change_state(element, change);
  if (change == GST_STATE_CHANGE_PAUSED_TO_READY) {
    RemoveRoutes(self);
    gst_flow_combiner_reset(self->state->combiner);
  }
  return result;
}

static GstStructure* Stats(RxState& state) {
  RxLock lock(state.mutex);
  const auto& s = state.generator.stats();
  const auto u64 = [](auto v) { return static_cast<guint64>(v); };
  return gst_structure_new(
      "application/x-screamrx-stats", "packets-received", G_TYPE_UINT64, u64(s.packets),
      "bytes-received", G_TYPE_UINT64, u64(s.received.bytes()), "packets-ce", G_TYPE_UINT64,
      u64(s.ce_packets), "packets-lost", G_TYPE_UINT64, u64(s.lost), "packets-reordered",
      G_TYPE_UINT64, u64(s.reordered), "packets-duplicate", G_TYPE_UINT64, u64(s.duplicates),
      "packets-stale", G_TYPE_UINT64, u64(s.stale), "packets-foreign", G_TYPE_UINT64, state.foreign,
      "malformed", G_TYPE_UINT64, state.malformed, "reports-sent", G_TYPE_UINT64, u64(s.reports),
      "report-bytes", G_TYPE_UINT64, u64(s.sent.bytes()), "peer-moves", G_TYPE_UINT64, state.moves,
      "goodbyes", G_TYPE_UINT64, state.goodbyes, "ssrcs", G_TYPE_UINT,
      static_cast<guint>(state.ssrcs.size()), nullptr);
}

static void SetPropertyVfunc(GObject* o, guint id, const GValue* v, GParamSpec*) {
  RxState& state = StateOf(o);
  RxLock lock(state.mutex);
  if (id == kPropPtMap) {
    state.pt_map.reset(static_cast<GstStructure*>(g_value_dup_boxed(v)));
    return;
  }
  SetProperty(state.settings, kProperties[id - 1], v);
  state.settings_changed = true;
  if (state.timer != nullptr) gst_clock_id_unschedule(state.timer);
}

static void GetPropertyVfunc(GObject* o, guint id, GValue* v, GParamSpec*) {
  RxState& state = StateOf(o);
  if (id == kPropStats) return g_value_take_boxed(v, Stats(state));
  RxLock lock(state.mutex);
  if (id == kPropPtMap) {
    g_value_set_boxed(v, state.pt_map.get());
  } else {
    GetProperty(state.settings, kProperties[id - 1], v);
  }
}

static void InstallOwnProperties(GObjectClass* object) {
  constexpr auto kRead = static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS);
  constexpr auto kReadWrite = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                       GST_PARAM_MUTABLE_READY);
  g_object_class_install_property(
      object, kPropPtMap,
      g_param_spec_boxed("pt-map", "pt-map",
                         "Caps of each payload type (application/x-rtp-pt-map,96=(string)\"...\"); "
                         "with it every SSRC leaves by a pad of its own",
                         GST_TYPE_STRUCTURE, kReadWrite));
  g_object_class_install_property(
      object, kPropStats,
      g_param_spec_boxed("stats", "stats", "Counters of packets, bytes and reports",
                         GST_TYPE_STRUCTURE, kRead));
}

static GstPad* AddStaticPad(GstLidarScreamRx* self, GstStaticPadTemplate* templ) {
  GstPad* pad = gst_pad_new_from_static_template(templ, templ->name_template);
  gst_pad_set_iterate_internal_links_function(pad, LinksOf);
  gst_element_add_pad(GST_ELEMENT(self), pad);
  return pad;
}

static void gst_lidar_scream_rx_init(GstLidarScreamRx* self) {
  self->state = new RxState;
  self->state->combiner = gst_flow_combiner_new();
  self->sink = AddStaticPad(self, &sink_template);
  gst_pad_set_chain_function(self->sink, RxChain);
  gst_pad_set_chain_list_function(self->sink, RxChainList);
  gst_pad_set_event_function(self->sink, SinkEvent);
  gst_pad_set_query_function(self->sink, SinkQuery);
  GST_PAD_SET_PROXY_CAPS(self->sink);
  GST_PAD_SET_PROXY_ALLOCATION(self->sink);
  self->src = AddStaticPad(self, &src_template);
  GST_PAD_SET_PROXY_CAPS(self->src);
  gst_flow_combiner_add_pad(self->state->combiner, self->src);
  self->rtcp_src = AddStaticPad(self, &rtcp_template);
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
  object->set_property = SetPropertyVfunc;
  object->get_property = GetPropertyVfunc;
  object->finalize = Finalize;
  InstallProperties(object, kProperties);
  InstallOwnProperties(object);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  gst_element_class_add_static_pad_template(element, &sink_template);
  gst_element_class_add_static_pad_template(element, &src_template);
  gst_element_class_add_static_pad_template(element, &stream_template);
  gst_element_class_add_static_pad_template(element, &rtcp_template);
  gst_element_class_set_static_metadata(element, "SCReAM receiver", "Filter/Network/RTP",
                                        "Congestion control feedback for RTP (RFC 8888) with ECN",
                                        "gst-lidar");
  gst_type_mark_as_plugin_api(NumReportsType(), static_cast<GstPluginAPIFlags>(0));
}
