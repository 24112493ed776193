// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-screamsink
 *
 * screamtx and UDP with ECN in one bin; the receiver's feedback comes back on the same socket.
 *
 * |[
 * gst-launch-1.0 lidartestsrc is-live=true ! dracoenc ! rtplidarpay ! screamsink host=127.0.0.1
 * port=5004
 * ]|
 */
#include "gst/scream/bin/gstscreamsink.h"

#include <gst/net/gstnetaddressmeta.h>

#include <array>
#include <atomic>
#include <mutex>

#include "gst/common/refs.h"
#include "gst/scream/bin/common.h"
#include "gst/scream/bin/gstscreamsinkpad.h"
#include "gst/scream/srtp/layer.h"
#include "gst/scream/tx/settings.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_scream_sink_debug);
#define GST_CAT_DEFAULT gst_lidar_scream_sink_debug

using namespace lidar::gst;

namespace {

/// Those that the children have too are theirs: set and read there.
struct Settings {
  std::string host = "127.0.0.1";
  guint port = 5004;
  std::string bind_address;
  guint bind_port = 0;
  bool strict_feedback = true;
  gint dscp = -1;
  guint min_bps = TxSettings{}.min_bps;
  guint start_bps = TxSettings{}.start_bps;
  guint max_bps = TxSettings{}.max_bps;
  gint ecn_mode = TxSettings{}.ecn_mode;
  guint64 max_queue_delay = TxSettings{}.max_queue_delay;
  guint64 stats_interval = TxSettings{}.stats_interval;
  bool send_bye = true;
  bool key_unit_on_loss = TxSettings{}.key_unit_on_loss;
  SrtpSettings srtp;
};

constexpr gint kLive = GST_PARAM_MUTABLE_PLAYING;
const std::array<Property<Settings>, 14> kProperties = {{
    {"host", "Receiver: a name or an address", &Settings::host},
    {"port", "UDP port of the receiver", &Settings::port, 1, 65535},
    {"bind-address", "Local address to send from; empty for any", &Settings::bind_address},
    {"bind-port", "Local UDP port to send from; 0 for any", &Settings::bind_port, 0, 65535},
    {"strict-feedback",
     "Take feedback only from the host and port that media goes to; else from any port of the host",
     &Settings::strict_feedback},
    {"dscp", "Differentiated services code point; -1 for none", &Settings::dscp, -1, 63, kLive},
    {"min-bitrate", "Lowest target of a pad without its own, IP included [bit/s]",
     &Settings::min_bps, 1, 4294967295.0, kLive},
    {"start-bitrate", "First target of a pad without its own, IP included [bit/s]",
     &Settings::start_bps, 1, 4294967295.0, kLive},
    {"max-bitrate", "Highest target of a pad without its own, IP included [bit/s]",
     &Settings::max_bps, 1, 4294967295.0, kLive},
    {"ecn-mode", "ECN codepoint of sent packets; ect1 also selects the L4S reaction",
     EnumField<Settings>{&Settings::ecn_mode, EcnModeType}},
    {"max-queue-delay",
     "Live input older than this is dropped in whole frames, other input waits [ns]",
     &Settings::max_queue_delay, 1e6, 60e9},
    {"stats-interval", "Time between element messages with the statistics; 0 for none [ns]",
     &Settings::stats_interval, 0, static_cast<gdouble>(G_MAXINT64), kLive},
    {"send-bye", "Send an RTCP BYE at EOS, so that the receiver ends too", &Settings::send_bye, 0,
     0, kLive},
    {"key-unit-on-loss", "Ask a video encoder for a key frame when the network lost packets",
     &Settings::key_unit_on_loss, 0, 0, kLive},
}};
enum : guint { kPropEstimatedBitrate = kProperties.size() + 1, kPropStats, kPropSrtp };

struct State {
  std::mutex mutex;  // guards settings, socket and peer
  Settings settings;
  SocketPtr socket;
  SocketAddressPtr peer;
  std::atomic<guint64> foreign{0};
  std::shared_ptr<SrtpLayer> srtp;
};

}  // namespace

struct _GstLidarScreamSink {
  GstBin parent;
  GstElement* tx;
  GstElement* sink;
  GstElement* src;
  State* state;
};

static void ChildProxyInit(gpointer iface, gpointer);

G_DEFINE_TYPE_WITH_CODE(GstLidarScreamSink, gst_lidar_scream_sink, GST_TYPE_BIN,
                        G_IMPLEMENT_INTERFACE(GST_TYPE_CHILD_PROXY, ChildProxyInit))
GST_ELEMENT_REGISTER_DEFINE(screamsink, "screamsink", GST_RANK_NONE, GST_TYPE_LIDAR_SCREAM_SINK)

static GstStaticPadTemplate sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink_%u", GST_PAD_SINK, GST_PAD_REQUEST, GST_STATIC_CAPS("application/x-rtp"));

static bool SameHost(GSocketAddress* a, GSocketAddress* b) {
  return g_inet_address_equal(g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(a)),
                              g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(b))) != FALSE;
}

/// Whether `buffer` comes from whom we send to. The receivers of a multicast group are many.
static bool FromPeer(GstLidarScreamSink* self, GstBuffer* buffer) {
  State& state = *self->state;
  const GstNetAddressMeta* meta = gst_buffer_get_net_address_meta(buffer);
  std::lock_guard lock(state.mutex);
  if (meta == nullptr || !state.peer || !G_IS_INET_SOCKET_ADDRESS(meta->addr)) return false;
  GInetAddress* host = g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(state.peer.get()));
  if (g_inet_address_get_is_multicast(host)) return true;
  if (!state.settings.strict_feedback) return SameHost(meta->addr, state.peer.get());
  return ToNative(meta->addr, G_SOCKET_FAMILY_IPV6) ==
         ToNative(state.peer.get(), G_SOCKET_FAMILY_IPV6);
}

static gboolean DropForeign(GstBuffer** buffer, guint, gpointer data) {
  auto* self = GST_LIDAR_SCREAM_SINK(data);
  if (FromPeer(self, *buffer)) return TRUE;
  ++self->state->foreign;
  gst_clear_buffer(buffer);
  return TRUE;
}

static GstPadProbeReturn FilterFeedback(GstPad*, GstPadProbeInfo* info, gpointer data) {
  auto* self = GST_LIDAR_SCREAM_SINK(data);
  if ((info->type & GST_PAD_PROBE_TYPE_BUFFER_LIST) != 0) {
    GstBufferList* list = gst_buffer_list_make_writable(GST_PAD_PROBE_INFO_BUFFER_LIST(info));
    gst_buffer_list_foreach(list, DropForeign, self);
    info->data = list;
    return gst_buffer_list_length(list) > 0 ? GST_PAD_PROBE_OK : GST_PAD_PROBE_DROP;
  }
  if (FromPeer(self, GST_PAD_PROBE_INFO_BUFFER(info))) return GST_PAD_PROBE_OK;
  ++self->state->foreign;
  return GST_PAD_PROBE_DROP;
}

static bool Fail(GstLidarScreamSink* self, const char* what, const Settings& s, GError* error) {
  GST_ELEMENT_ERROR(self, RESOURCE, OPEN_WRITE, ("%s: %s", what, error->message),
                    ("host %s port %u bind-address '%s' bind-port %u", s.host.c_str(), s.port,
                     s.bind_address.c_str(), s.bind_port));
  g_error_free(error);
  return false;
}

/// Opens the socket for both ways and hands it to the children.
static bool Open(GstLidarScreamSink* self) {
  State& state = *self->state;
  std::unique_lock lock(state.mutex);
  const Settings s = state.settings;
  lock.unlock();
  for (const auto& [child, name] :
       {std::pair{self->tx, "screamtx"}, {self->sink, "ecnudpsink"}, {self->src, "ecnudpsrc"}}) {
    if (child != nullptr) continue;
    ReportMissing(GST_ELEMENT(self), name);
    return false;
  }
  GError* error = nullptr;
  SocketAddressPtr peer(ResolveUdpAddress(s.host, s.port, &error));
  if (!peer) return Fail(self, "Cannot resolve the host", s, error);
  const UdpBind bind{s.bind_address, s.bind_port, g_socket_address_get_family(peer.get()), false};
  SocketPtr socket(OpenUdpSocket(bind, &error));
  if (!socket) return Fail(self, "Cannot open a UDP socket", s, error);
  GInetAddress* host = g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(peer.get()));
  // As resolved here: a name may stand for several addresses.
  const StringPtr literal(g_inet_address_to_string(host));
  g_object_set(self->sink, "host", literal.get(), "port", s.port, nullptr);
  g_object_set(self->tx, "packet-overhead", OverheadOf(peer.get()), nullptr);
  GiveSocket(self->sink, socket.get());
  GiveSocket(self->src, socket.get());
  std::shared_ptr<SrtpLayer> srtp;
  if (!StartSrtp(s.srtp,
                 {GST_ELEMENT(self), self->tx, "src", "rtcp_sink", self->sink, self->src, true},
                 &srtp))
    return false;
  if (srtp)
    g_object_set(self->tx, "packet-overhead", OverheadOf(peer.get()) + srtp->overhead(), nullptr);
  lock.lock();
  state.srtp = std::move(srtp);
  state.socket = std::move(socket);
  state.peer = std::move(peer);
  state.foreign = 0;
  return true;
}

static void Close(GstLidarScreamSink* self) {
  State& state = *self->state;
  std::unique_lock srtp_lock(state.mutex);
  const std::shared_ptr<SrtpLayer> srtp = std::move(state.srtp);
  srtp_lock.unlock();
  for (GstElement* child : {self->sink, self->src})
    if (child != nullptr) GiveSocket(child, nullptr);
  std::lock_guard lock(state.mutex);
  if (state.socket) g_socket_close(state.socket.get(), nullptr);
  state.socket.reset();
  state.peer.reset();
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange change) {
  auto* self = GST_LIDAR_SCREAM_SINK(element);
  if (change == GST_STATE_CHANGE_NULL_TO_READY && !Open(self)) {
    Close(self);
    return GST_STATE_CHANGE_FAILURE;
  }
  GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_lidar_scream_sink_parent_class)->change_state(element, change);
  // The source of feedback is live; that says nothing about the media.
  if (result == GST_STATE_CHANGE_NO_PREROLL) result = GST_STATE_CHANGE_SUCCESS;
  if (change == GST_STATE_CHANGE_READY_TO_NULL) Close(self);
  return result;
}

static GstPad* RequestPad(GstElement* element, GstPadTemplate* templ, const gchar* name,
                          const GstCaps* caps) {
  auto* self = GST_LIDAR_SCREAM_SINK(element);
  if (self->tx == nullptr) return nullptr;
  GstPadTemplate* inner =
      gst_element_class_get_pad_template(GST_ELEMENT_GET_CLASS(self->tx), "sink_%u");
  const PadPtr target(gst_element_request_pad(self->tx, inner, name, caps));
  if (!target) return nullptr;
  const StringPtr pad_name(gst_pad_get_name(target.get()));
  auto* ghost = GST_PAD(g_object_new(GST_TYPE_LIDAR_SCREAM_SINK_PAD, "name", pad_name.get(),
                                     "direction", GST_PAD_SINK, "template", templ, nullptr));
  gst_ghost_pad_set_target(GST_GHOST_PAD(ghost), target.get());
  if (GST_STATE(element) > GST_STATE_READY || GST_STATE_NEXT(element) > GST_STATE_READY)
    gst_pad_set_active(ghost, TRUE);
  gst_element_add_pad(element, ghost);
  gst_child_proxy_child_added(GST_CHILD_PROXY(element), G_OBJECT(ghost), pad_name.get());
  return ghost;
}

static void ReleasePad(GstElement* element, GstPad* pad) {
  auto* self = GST_LIDAR_SCREAM_SINK(element);
  const PadPtr target(gst_ghost_pad_get_target(GST_GHOST_PAD(pad)));
  gst_ghost_pad_set_target(GST_GHOST_PAD(pad), nullptr);
  if (target) gst_element_release_request_pad(self->tx, target.get());
  const StringPtr name(gst_pad_get_name(pad));
  gst_child_proxy_child_removed(GST_CHILD_PROXY(element), G_OBJECT(pad), name.get());
  gst_element_remove_pad(element, pad);
}

/// The pads are children behind the elements of the bin, so that sink_0::priority can be set.
static GstChildProxyInterface* BinChildProxy() {
  return static_cast<GstChildProxyInterface*>(
      g_type_interface_peek(gst_lidar_scream_sink_parent_class, GST_TYPE_CHILD_PROXY));
}

static void ChildProxyInit(gpointer iface, gpointer) {
  auto* proxy = static_cast<GstChildProxyInterface*>(iface);
  proxy->get_children_count = [](GstChildProxy* p) -> guint {
    const guint elements = BinChildProxy()->get_children_count(p);
    GST_OBJECT_LOCK(p);
    const guint pads = GST_ELEMENT(p)->numsinkpads;
    GST_OBJECT_UNLOCK(p);
    return elements + pads;
  };
  proxy->get_child_by_index = [](GstChildProxy* p, guint index) -> GObject* {
    const guint elements = BinChildProxy()->get_children_count(p);
    if (index < elements) return BinChildProxy()->get_child_by_index(p, index);
    GST_OBJECT_LOCK(p);
    gpointer pad = g_list_nth_data(GST_ELEMENT(p)->sinkpads, index - elements);
    if (pad != nullptr) gst_object_ref(pad);
    GST_OBJECT_UNLOCK(p);
    return static_cast<GObject*>(pad);
  };
  // GstBin's own looks at its elements only.
  proxy->get_child_by_name = [](GstChildProxy* p, const gchar* name) -> GObject* {
    if (GstPad* pad = gst_element_get_static_pad(GST_ELEMENT(p), name)) return G_OBJECT(pad);
    return BinChildProxy()->get_child_by_name(p, name);
  };
}

static void SetPropertyVfunc(GObject* o, guint id, const GValue* v, GParamSpec* spec) {
  auto* self = GST_LIDAR_SCREAM_SINK(o);
  if (id >= kPropSrtp) {
    SetSrtpProperty(GST_ELEMENT(self), *self->state, id - kPropSrtp, v);
    return;
  }
  {
    std::lock_guard lock(self->state->mutex);
    SetProperty(self->state->settings, kProperties[id - 1], v);
  }
  Forward(self->tx, spec, v);
  if (std::string(spec->name) == "dscp") Forward(self->sink, spec, v);
}

static void AddUdpStats(GstLidarScreamSink* self, GstStructure* stats) {
  gst_structure_set(stats, "feedback-foreign-address", G_TYPE_UINT64, self->state->foreign.load(),
                    nullptr);
  {
    std::lock_guard lock(self->state->mutex);
    AddSrtpStats(self->state->srtp.get(), stats);
  }
  GstStructure* udp = nullptr;
  if (self->sink != nullptr) g_object_get(self->sink, "stats", &udp, nullptr);
  if (udp == nullptr) return;
  guint64 errors = 0;
  gst_structure_get_uint64(udp, "send-errors", &errors);
  gst_structure_set(stats, "send-errors", G_TYPE_UINT64, errors, nullptr);
  gst_structure_free(udp);
}

static void GetPropertyVfunc(GObject* o, guint id, GValue* v, GParamSpec* spec) {
  auto* self = GST_LIDAR_SCREAM_SINK(o);
  if (id == kPropStats || id == kPropEstimatedBitrate) {
    if (self->tx == nullptr) return;
    g_object_get_property(G_OBJECT(self->tx), spec->name, v);
    if (id == kPropStats) AddUdpStats(self, static_cast<GstStructure*>(g_value_get_boxed(v)));
    return;
  }
  std::lock_guard lock(self->state->mutex);
  if (id >= kPropSrtp) {
    GetSrtpProperty(self->state->settings.srtp, id - kPropSrtp, v);
  } else {
    GetProperty(self->state->settings, kProperties[id - 1], v);
  }
}

static void InstallOwnProperties(GObjectClass* object) {
  constexpr auto kRead = static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS);
  g_object_class_install_property(
      object, kPropEstimatedBitrate,
      g_param_spec_uint("estimated-bitrate", "estimated-bitrate",
                        "Target of all streams together, IP included; notifies [bit/s]", 0,
                        G_MAXUINT, 0, kRead));
  g_object_class_install_property(
      object, kPropStats,
      g_param_spec_boxed("stats", "stats", "Statistics; bitrates in bit/s, times in ns",
                         GST_TYPE_STRUCTURE, kRead));
  InstallSrtpProperties(object, kPropSrtp);
}

static void gst_lidar_scream_sink_init(GstLidarScreamSink* self) {
  auto* element = GST_ELEMENT(self);
  self->state = new State;
  gst_bin_set_suppressed_flags(GST_BIN(self), GST_ELEMENT_FLAG_SOURCE);
  self->tx = AddChild(element, "screamtx", "screamtx");
  self->sink = AddChild(element, "ecnudpsink", "ecnudpsink");
  self->src = AddChild(element, "ecnudpsrc", "ecnudpsrc");
  if (self->tx == nullptr || self->sink == nullptr || self->src == nullptr) return;
  g_object_set(self->tx, "send-bye", TRUE, nullptr);
  g_object_set(self->sink, "sync", FALSE, "async", FALSE, nullptr);
  gst_element_link_pads(self->tx, "src", self->sink, "sink");
  gst_element_link_pads(self->src, "src", self->tx, "rtcp_sink");
  const PadPtr feedback(gst_element_get_static_pad(self->src, "src"));
  gst_pad_add_probe(
      feedback.get(),
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST),
      FilterFeedback, self, nullptr);
  g_signal_connect_swapped(
      self->tx, "notify::estimated-bitrate",
      G_CALLBACK(+[](GObject* bin) { g_object_notify(bin, "estimated-bitrate"); }), self);
}

static void gst_lidar_scream_sink_class_init(GstLidarScreamSinkClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_scream_sink_debug, "screamsink", 0, "SCReAM sink bin");
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = SetPropertyVfunc;
  object->get_property = GetPropertyVfunc;
  object->finalize = [](GObject* o) {
    delete GST_LIDAR_SCREAM_SINK(o)->state;
    G_OBJECT_CLASS(gst_lidar_scream_sink_parent_class)->finalize(o);
  };
  InstallProperties(object, kProperties);
  InstallOwnProperties(object);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  element->request_new_pad = RequestPad;
  element->release_pad = ReleasePad;
  gst_element_class_add_static_pad_template_with_gtype(element, &sink_template,
                                                       GST_TYPE_LIDAR_SCREAM_SINK_PAD);
  gst_element_class_set_static_metadata(
      element, "SCReAM network sink", "Sink/Network/RTP",
      "Sends RTP over UDP with SCReAM v2 congestion control and L4S", "gst-lidar");
  gst_type_mark_as_plugin_api(GST_TYPE_LIDAR_SCREAM_SINK_PAD, static_cast<GstPluginAPIFlags>(0));
}
