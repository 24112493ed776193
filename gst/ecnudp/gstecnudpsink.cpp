// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-ecnudpsink
 *
 * Sends each buffer as one UDP datagram whose ECN bits come from the buffer's LidarEcnMeta, or from
 * the property `ecn` if it has none.
 *
 * |[
 * gst-launch-1.0 audiotestsrc ! audioconvert ! rtpL16pay ! ecnudpsink \
 *   host=127.0.0.1 port=5004 ecn=ect1
 * ]|
 */
#include <gst/base/gstbasesink.h>

#include <gst/net/gstnetaddressmeta.h>
#include <netinet/in.h>

#include <cerrno>
#include <mutex>
#include <optional>

#include "gst/common/element_class.h"
#include "gst/common/enum_type.h"
#include "gst/common/properties.h"
#include "gst/common/stats.h"
#include "gst/lidar/gstlidar.h"
#include "gst/net/udp_batch.h"
#include "gst/net/udp_element.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_ecn_udp_sink_debug);
#define GST_CAT_DEFAULT gst_lidar_ecn_udp_sink_debug

namespace {

using namespace lidar::gst;

constexpr guint8 kEcnMask = 0x03;

GType EcnType() {
  static const GEnumValue values[] = {{GST_LIDAR_ECN_NOT_ECT, "Not ECN-capable", "not-ect"},
                                      {GST_LIDAR_ECN_ECT1, "ECT(1): L4S", "ect1"},
                                      {GST_LIDAR_ECN_ECT0, "ECT(0): classic ECN", "ect0"},
                                      {GST_LIDAR_ECN_CE, "Congestion experienced", "ce"},
                                      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarEcnUdpSinkEcn", values);
  return type;
}

struct SinkSettings {
  UdpTarget target;
  gint ecn = GST_LIDAR_ECN_NOT_ECT;
  UdpOptions options;
  GivenSocket given;
  bool reply = false;
  std::string interface;
  std::string multicast_iface;
  gint ttl_mc = 1;
  guint buffer_size = 0;
};

struct Counters {
  guint64 packets = 0;
  guint64 bytes = 0;
  guint64 errors = 0;
  guint64 no_peer = 0;
};
const std::array<Stat<Counters>, 4> kStats = {{
    {"packets-sent", &Counters::packets},
    {"bytes-sent", &Counters::bytes},
    {"send-errors", &Counters::errors},
    {"dropped-no-peer", &Counters::no_peer},
}};

struct State {
  std::mutex mutex;  // guards members up to the next comment; not held while sending or posting
  SinkSettings settings;
  SocketInUse used;
  SharedSocketAddress peer;
  Counters counters;

  // The members below are used only by the streaming thread, between start and stop.
  WakeFd wake;
  UdpBatchSender batch;
  NativeAddress to;
  GSocketFamily family = G_SOCKET_FAMILY_INVALID;
  guint8 socket_tos = 0;
  int warned_errno = 0;
};

/// The settings that apply to one call of render.
struct Marking {
  guint8 dscp_bits;
  guint8 ecn;
  bool reply;
  std::optional<unsigned> interface;  // 0: by the routes; unset: the interface does not exist
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarEcnUdpSink, gst_lidar_ecn_udp_sink, GST, LIDAR_ECN_UDP_SINK,
                     GstBaseSink)
struct _GstLidarEcnUdpSink {
  GstBaseSink parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarEcnUdpSink, gst_lidar_ecn_udp_sink, GST_TYPE_BASE_SINK)
GST_ELEMENT_REGISTER_DEFINE(ecnudpsink, "ecnudpsink", GST_RANK_NONE,
                            gst_lidar_ecn_udp_sink_get_type())

static State& StateOf(gpointer self) { return *GST_LIDAR_ECN_UDP_SINK(self)->state; }

static SharedSocketAddress PeerAddress(GObject* object) {
  State& state = StateOf(object);
  const std::lock_guard lock(state.mutex);
  return state.peer;
}

static StructurePtr Stats(GObject* object) {
  State& state = StateOf(object);
  const std::lock_guard lock(state.mutex);
  return ToStructure("application/x-ecnudpsink-stats", kStats, state.counters);
}

static const std::array<Property<SinkSettings>, 16> kProperties = {{
    Within<&SinkSettings::target>(UdpTargetRows(), "host"),
    Within<&SinkSettings::target>(UdpTargetRows(), "port"),
    Within<&SinkSettings::target>(UdpTargetRows(), "bind-address"),
    Within<&SinkSettings::target>(UdpTargetRows(), "bind-port"),
    {"ecn", "ECN bits of buffers without LidarEcnMeta",
     EnumField<SinkSettings>{&SinkSettings::ecn, EcnType}, 0, 0, GST_PARAM_MUTABLE_PLAYING},
    Within<&SinkSettings::options>(UdpOptionRows(), "qos-dscp"),
    {"close-socket", "Close the socket of the property socket when the element stops",
     At<&SinkSettings::given, &GivenSocket::close>},
    {"reply",
     "Send to the address in the buffer's GstNetAddressMeta instead of host and port; a buffer "
     "without one goes to the latest such address",
     &SinkSettings::reply},
    {"interface",
     "Network interface that datagrams leave by; it may disappear and return. Empty: as the routes "
     "say",
     &SinkSettings::interface},
    {"multicast-iface", "Network interface for multicast; empty: the kernel chooses it",
     &SinkSettings::multicast_iface},
    {"ttl-mc", "Time to live of multicast datagrams [hops]", &SinkSettings::ttl_mc, 0, 255},
    {"buffer-size", "Kernel send buffer [bytes]; 0 for its default", &SinkSettings::buffer_size, 0,
     G_MAXINT},
    {"socket", "Socket to send from; NULL opens one",
     At<&SinkSettings::given, &GivenSocket::socket>},
    {"used-socket", "Socket in use; NULL when stopped", UsedSocket<GstLidarEcnUdpSink>},
    {"peer-address", "Present destination of datagrams; NULL: none", PeerAddress},
    {"stats", "packets-sent, bytes-sent [bytes], send-errors, dropped-no-peer", Stats},
}};

static guint8 SocketTos(int fd, bool v6) {
  int tos = 0;
  socklen_t size = sizeof tos;
  if (getsockopt(fd, v6 ? IPPROTO_IPV6 : IPPROTO_IP, v6 ? IPV6_TCLASS : IP_TOS, &tos, &size) != 0)
    return 0;
  return static_cast<guint8>(tos & ~kEcnMask);
}

static void ConfigureSocket(GstLidarEcnUdpSink* self, GSocket* socket, const SinkSettings& s) {
  if (s.buffer_size > 0)
    g_socket_set_option(socket, SOL_SOCKET, SO_SNDBUF, static_cast<gint>(s.buffer_size), nullptr);
  g_socket_set_multicast_ttl(socket, static_cast<guint>(s.ttl_mc));
  if (!s.multicast_iface.empty() &&
      !lidar::net::SendMulticastFrom(g_socket_get_fd(socket), s.multicast_iface))
    GST_ELEMENT_WARNING(self, RESOURCE, SETTINGS,
                        ("The multicast-iface %s cannot be used: %s.", s.multicast_iface.c_str(),
                         g_strerror(errno)),
                        ("multicast leaves by the interface that the kernel chooses"));
}

static gboolean Start(GstBaseSink* base) {
  auto* self = GST_LIDAR_ECN_UDP_SINK(base);
  State& state = StateOf(self);
  const SinkSettings s = Snapshot(state);
  SharedSocketAddress peer;
  if (!s.reply && !(peer = ResolveTarget(GST_ELEMENT(self), s.target))) return FALSE;
  const GSocketFamily family =
      peer ? g_socket_address_get_family(peer.get()) : G_SOCKET_FAMILY_INVALID;
  SocketInUse used =
      TakeSocket(s.given, [&] { return OpenSending(GST_ELEMENT(self), s.target, family); });
  if (!used.socket) return FALSE;
  GSocket* socket = used.socket.get();
  ConfigureSocket(self, socket, s);
  state.family = g_socket_get_family(socket);
  state.to = peer ? ToNative(peer.get(), state.family) : NativeAddress{};
  state.socket_tos = SocketTos(g_socket_get_fd(socket),
                               state.family == G_SOCKET_FAMILY_IPV6 && !state.to.IsIpv4());
  state.warned_errno = 0;
  state.wake.Clear();
  if (peer && !state.to.valid()) {
    GST_ELEMENT_ERROR(
        self, RESOURCE, SETTINGS,
        ("The host %s does not have the address family of the socket.", s.target.host.c_str()),
        ("use an address of the other family, or another bind-address"));
    return FALSE;
  }
  GST_DEBUG_OBJECT(self, "sending to %s", AddressToString(peer.get()).c_str());
  const std::lock_guard lock(state.mutex);
  state.used = std::move(used);
  state.peer = std::move(peer);
  state.counters = {};
  return TRUE;
}

static gboolean Stop(GstBaseSink* base) {
  State& state = StateOf(base);
  std::lock_guard lock(state.mutex);
  state.used.Close(state.settings.given.close);
  state.peer.reset();
  return TRUE;
}

/// Makes the address that is attached to `buffer` the destination. The element that has attached
/// the address (screamrx) has validated the peer.
static void FollowPeer(State& state, GstBuffer* buffer) {
  const GstNetAddressMeta* meta = gst_buffer_get_net_address_meta(buffer);
  if (meta == nullptr || meta->addr == state.peer.get()) return;
  state.to = ToNative(meta->addr, state.family);
  std::lock_guard lock(state.mutex);
  state.peer.reset(G_SOCKET_ADDRESS(g_object_ref(meta->addr)), GObjectUnref{});
}

static Marking CurrentMarking(State& state) {
  std::lock_guard lock(state.mutex);
  const SinkSettings& s = state.settings;
  const guint8 dscp =
      s.options.dscp < 0 ? state.socket_tos : static_cast<guint8>(s.options.dscp << 2);
  Marking marking{dscp, static_cast<guint8>(s.ecn), s.reply, 0};
  if (s.interface.empty()) return marking;
  // The index is looked up for each call, because an interface that was removed returns with
  // another index.
  const int fd = g_socket_get_fd(state.used.socket.get());
  if (const unsigned index = lidar::net::InterfaceIndex(fd, s.interface))
    marking.interface = index;
  else
    marking.interface.reset();
  return marking;
}

/// Warns once for each new kind of error. Errors do not end the stream, because a path may be down
/// for a while.
static void WarnOnce(GstLidarEcnUdpSink* self, const UdpBatchSender::Result& result) {
  State& state = StateOf(self);
  if (result.last_errno == 0) {
    if (result.packets > 0) state.warned_errno = 0;
    return;
  }
  if (state.warned_errno == result.last_errno) return;
  state.warned_errno = result.last_errno;
  GST_ELEMENT_WARNING(self, RESOURCE, WRITE, ("Sending failed: %s.", g_strerror(result.last_errno)),
                      ("to %s; datagrams are dropped and counted until sending works again",
                       AddressToString(state.peer.get()).c_str()));
}

static GstFlowReturn Flush(GstLidarEcnUdpSink* self) {
  State& state = StateOf(self);
  const auto result = state.batch.Flush(g_socket_get_fd(state.used.socket.get()), state.wake);
  {
    std::lock_guard lock(state.mutex);
    AddCounts(kStats, {result.packets, result.bytes, result.errors, 0}, &state.counters);
  }
  GST_LOG_OBJECT(self, "sent %u datagrams, %u failed", result.packets, result.errors);
  WarnOnce(self, result);
  return result.woken ? GST_FLOW_FLUSHING : GST_FLOW_OK;
}

/// Adds `buffer` to the batch, which must not be full. If the buffer cannot be mapped, posts an
/// error message and returns false.
static bool Add(GstLidarEcnUdpSink* self, GstBuffer* buffer, const Marking& marking) {
  State& state = StateOf(self);
  if (marking.reply) FollowPeer(state, buffer);
  if (!state.to.valid()) {
    std::lock_guard lock(state.mutex);
    ++state.counters.no_peer;
    return true;
  }
  if (!marking.interface) {
    WarnOnce(self, {0, 0, 1, ENODEV, false});
    const std::lock_guard lock(state.mutex);
    ++state.counters.errors;
    return true;
  }
  auto ecn = static_cast<GstLidarEcn>(marking.ecn);
  gst_lidar_buffer_get_ecn(buffer, &ecn, nullptr);
  const auto tos = static_cast<guint8>(marking.dscp_bits | (static_cast<guint8>(ecn) & kEcnMask));
  if (state.batch.Add(buffer, tos, state.to, *marking.interface)) return true;
  GST_ELEMENT_ERROR(self, RESOURCE, READ, (nullptr), ("cannot map an input buffer"));
  return false;
}

static GstFlowReturn Render(GstBaseSink* base, GstBuffer* buffer) {
  auto* self = GST_LIDAR_ECN_UDP_SINK(base);
  if (!Add(self, buffer, CurrentMarking(StateOf(self)))) return GST_FLOW_ERROR;
  return Flush(self);
}

static GstFlowReturn RenderList(GstBaseSink* base, GstBufferList* list) {
  auto* self = GST_LIDAR_ECN_UDP_SINK(base);
  State& state = StateOf(self);
  const Marking marking = CurrentMarking(state);
  const guint n = gst_buffer_list_length(list);
  for (guint i = 0; i < n; ++i) {
    if (!Add(self, gst_buffer_list_get(list, i), marking)) return GST_FLOW_ERROR;
    if (!state.batch.full()) continue;
    const GstFlowReturn flow = Flush(self);
    if (flow != GST_FLOW_OK) return flow;
  }
  return Flush(self);
}

static void gst_lidar_ecn_udp_sink_init(GstLidarEcnUdpSink* self) {
  self->state = new State;
  gst_base_sink_set_sync(GST_BASE_SINK(self), TRUE);
}

static void InstallVmethods(GstBaseSinkClass* sink) {
  sink->start = Start;
  sink->stop = Stop;
  sink->render = Render;
  sink->render_list = RenderList;
  WakeOnUnlock<GstLidarEcnUdpSink, GstBaseSink>(sink);
}

static void gst_lidar_ecn_udp_sink_class_init(GstLidarEcnUdpSinkClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_ecn_udp_sink_debug, "ecnudpsink", 0, "UDP sink with ECN");
  ServeState<GstLidarEcnUdpSink, gst_lidar_ecn_udp_sink_parent_class, kProperties>(klass);
  Describe(klass,
           {"UDP sink with ECN", "Sink/Network",
            "Sends datagrams with the ECN field set for each packet"},
           {{"sink", GST_PAD_SINK, "ANY"}});
  InstallVmethods(GST_BASE_SINK_CLASS(klass));
}
