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
#include "scream/gstscreamrx.h"

#include <gst/net/gstnetaddressmeta.h>

#include "common/buffer_map.h"
#include "scream/rx_private.h"

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

// A kernel time older than this, or in the future, means that somebody set the system clock.
static constexpr std::size_t kMaxSsrcs = 64;
static constexpr lidar::Duration kMaxAge = std::chrono::seconds(1);

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

/// Now on the clock of the reports, and on that of kernel arrival times.
struct Clocks {
  lidar::Time now;
  GstClockTime unix_now;
};

static Clocks ReadClocks(const RxState& state) {
  return {RxNow(state), static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND};
}

/// The kernel's arrival time on the reports' clock, which nobody sets.
static lidar::Time ArrivalTime(const Clocks& clocks, GstClockTime arrival) {
  if (!GST_CLOCK_TIME_IS_VALID(arrival)) return clocks.now;
  const auto age = lidar::Duration{static_cast<std::int64_t>(clocks.unix_now - arrival)};
  return age > lidar::Duration{0} && age < kMaxAge ? clocks.now - age : clocks.now;
}

static GSocketAddress* SourceOf(GstBuffer* buffer) {
  const GstNetAddressMeta* meta = gst_buffer_get_net_address_meta(buffer);
  return meta == nullptr ? nullptr : meta->addr;
}

/// Counts one packet of media; false where it is to be dropped. With the lock held.
static bool Account(RxState& state, const Clocks& clocks, GstBuffer* buffer,
                    const RtpHeader& header) {
  const auto verdict = state.latch.OnPacket(clocks.now, SourceOf(buffer), header.ssrc, header.seq);
  if (verdict == PeerLatch::Verdict::kForeign) {
    ++state.foreign;
    return false;
  }
  if (verdict == PeerLatch::Verdict::kMoved) {
    ++state.moves;
    state.generator.Reset();
    state.ssrcs.clear();
  }
  GstLidarEcn ecn = GST_LIDAR_ECN_NOT_ECT;
  GstClockTime arrival = GST_CLOCK_TIME_NONE;
  gst_lidar_buffer_get_ecn(buffer, &ecn, &arrival);
  lidar::scream::ReceivedPacket packet;
  packet.ssrc = header.ssrc;
  packet.seq = header.seq;
  packet.ecn = static_cast<lidar::scream::Ecn>(ecn);
  packet.marker = header.marker;
  packet.size = lidar::DataSize::Bytes(static_cast<std::int64_t>(gst_buffer_get_size(buffer)) +
                                       state.settings.packet_overhead);
  state.generator.OnPacket(ArrivalTime(clocks, arrival), packet);
  // One that is alive comes back with its next packet.
  if (state.ssrcs.size() >= kMaxSsrcs) state.ssrcs.erase(state.ssrcs.begin());
  state.ssrcs.insert(header.ssrc);
  return true;
}

enum class Fate { kPass, kDrop, kEnd };

/// A goodbye on the media's port ends streams; other RTCP there goes on unread. Lock held.
static Fate LookAtRtcp(RxState& state, GstBuffer* buffer, const BufferMap& map) {
  const auto goodbyes = ParseBye(map.view());
  if (goodbyes.empty()) return Fate::kPass;
  if (!state.latch.IsPeer(SourceOf(buffer))) {
    ++state.foreign;
    return Fate::kDrop;
  }
  bool known = false;
  for (const guint32 ssrc : goodbyes) known = state.ssrcs.erase(ssrc) > 0 || known;
  if (known) ++state.goodbyes;
  return known && state.ssrcs.empty() && state.settings.eos_on_bye ? Fate::kEnd : Fate::kDrop;
}

static Fate Look(GstLidarScreamRx* self, const Clocks& clocks, GstBuffer* buffer,
                 RtpHeader* header) {
  RxState& state = *self->state;
  guint8 type = 0;
  gst_buffer_extract(buffer, 1, &type, 1);
  if (type >= 192 && type <= 223) {
    const BufferMap map(buffer, GST_MAP_READ);
    RxLock lock(state.mutex);
    if (map && IsRtcp(map.view())) return LookAtRtcp(state, buffer, map);
  }
  const auto read = ReadRtpHeader(buffer);
  RxLock lock(state.mutex);
  if (!read) {
    ++state.malformed;
    return Fate::kDrop;
  }
  *header = *read;
  if (!Account(state, clocks, buffer, *read)) return Fate::kDrop;
  WakeFeedback(state);
  return Fate::kPass;
}

static GstFlowReturn End(GstLidarScreamRx* self) {
  GST_INFO_OBJECT(self, "every stream has said goodbye");
  self->state->eos = true;
  ForwardToAll(self, gst_event_new_eos());
  return GST_FLOW_EOS;
}

static GstFlowReturn Chain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  auto* self = GST_LIDAR_SCREAM_RX(parent);
  BufferPtr owner(buffer);
  if (self->state->eos) return GST_FLOW_EOS;
  RtpHeader header;
  switch (Look(self, ReadClocks(*self->state), buffer, &header)) {
    case Fate::kDrop:
      return GST_FLOW_OK;
    case Fate::kEnd:
      return End(self);
    case Fate::kPass:
      break;
  }
  if (HasPtMap(self)) return Demux(self, header, owner.release());
  return gst_pad_push(self->src, owner.release());
}

static GstFlowReturn ChainList(GstPad* pad, GstObject* parent, GstBufferList* list) {
  auto* self = GST_LIDAR_SCREAM_RX(parent);
  const BufferListPtr owner(list);
  const bool demux = HasPtMap(self);
  const guint n = gst_buffer_list_length(list);
  if (demux) {
    GstFlowReturn flow = GST_FLOW_OK;
    for (guint i = 0; i < n && flow == GST_FLOW_OK; ++i)
      flow = Chain(pad, parent, gst_buffer_ref(gst_buffer_list_get(list, i)));
    return flow;
  }
  if (self->state->eos) return GST_FLOW_EOS;
  const Clocks clocks = ReadClocks(*self->state);
  BufferListPtr passed(gst_buffer_list_new_sized(n));
  bool end = false;
  for (guint i = 0; i < n && !end; ++i) {
    RtpHeader header;
    GstBuffer* buffer = gst_buffer_list_get(list, i);
    const Fate fate = Look(self, clocks, buffer, &header);
    if (fate == Fate::kPass) gst_buffer_list_add(passed.get(), gst_buffer_ref(buffer));
    end = fate == Fate::kEnd;
  }
  GstFlowReturn flow = GST_FLOW_OK;
  if (gst_buffer_list_length(passed.get()) > 0)
    flow = gst_pad_push_list(self->src, passed.release());
  return end && flow == GST_FLOW_OK ? End(self) : flow;
}

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
  gst_pad_set_chain_function(self->sink, Chain);
  gst_pad_set_chain_list_function(self->sink, ChainList);
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
