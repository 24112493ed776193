// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-ecnudpsrc
 *
 * Receives UDP datagrams, each with its sender's address (GstNetAddressMeta) and its ECN bits and
 * kernel arrival time (LidarEcnMeta). Without `caps` it has caps that downstream accepts.
 *
 * |[
 * gst-launch-1.0 ecnudpsrc port=5004 num-buffers=100 ! fakesink dump=true
 * ]|
 */
#include <gst/base/gstpushsrc.h>

#include <gst/net/gstnetaddressmeta.h>
#include <netinet/in.h>
#include <poll.h>

#include <cerrno>
#include <deque>
#include <mutex>

#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/common/stats.h"
#include "gst/lidar/gstlidar.h"
#include "gst/net/udp_batch.h"
#include "gst/net/udp_element.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_ecn_udp_src_debug);
#define GST_CAT_DEFAULT gst_lidar_ecn_udp_src_debug

namespace {

using namespace lidar::gst;

// The default receive buffer, which is enough for 1 s at 16 Mbit/s. There is no warning if the
// kernel grants less than this default.
constexpr guint kDefaultBuffer = 2u << 20;
constexpr gint kDefaultPayload = 96;

struct SrcSettings {
  UdpListen listen;
  UdpOptions options;
  GivenSocket given;
};

struct Counters {
  guint64 packets = 0;
  guint64 bytes = 0;
  guint64 ce = 0;
  guint kernel_drops = 0;
};
const std::array<Stat<Counters>, 4> kStats = {{
    {"packets-received", &Counters::packets},
    {"bytes-received", &Counters::bytes},
    {"packets-ce", &Counters::ce},
    {"dropped-by-kernel", &Counters::kernel_drops},
}};

struct State {
  std::mutex mutex;  // guards members up to the next comment; not held while receiving or posting
  SrcSettings settings;
  SocketInUse used;
  Counters counters;

  // The members below are used only by the streaming thread, between start and stop.
  WakeFd wake;
  UdpBatchReceiver batch;
  std::deque<BufferPtr> received;  // rest of the last batch
  NativeAddress last_from;
  SocketAddressPtr last_address;
  gint64 timeout_ns = -1;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarEcnUdpSrc, gst_lidar_ecn_udp_src, GST, LIDAR_ECN_UDP_SRC, GstPushSrc)
struct _GstLidarEcnUdpSrc {
  GstPushSrc parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarEcnUdpSrc, gst_lidar_ecn_udp_src, GST_TYPE_PUSH_SRC)
GST_ELEMENT_REGISTER_DEFINE(ecnudpsrc, "ecnudpsrc", GST_RANK_NONE, gst_lidar_ecn_udp_src_get_type())

static State& StateOf(gpointer self) { return *GST_LIDAR_ECN_UDP_SRC(self)->state; }

static StructurePtr Stats(GObject* object) {
  State& state = StateOf(object);
  const std::lock_guard lock(state.mutex);
  return ToStructure("application/x-ecnudpsrc-stats", kStats, state.counters);
}

static const std::array<Property<SrcSettings>, 11> kProperties = {{
    Within<&SrcSettings::listen>(UdpListenRows(), "address"),
    Within<&SrcSettings::listen>(UdpListenRows(), "port"),
    Within<&SrcSettings::listen>(UdpListenRows(), "multicast-group"),
    Within<&SrcSettings::listen>(UdpListenRows(), "multicast-iface"),
    Within<&SrcSettings::options>(UdpOptionRows(), "buffer-size"),
    Within<&SrcSettings::options>(UdpOptionRows(), "timeout"),
    Within<&SrcSettings::options>(UdpOptionRows(), "caps"),
    {"close-socket", "Close the socket of the property socket when the element stops",
     At<&SrcSettings::given, &GivenSocket::close>},
    {"socket", "Socket to receive from; NULL opens one",
     At<&SrcSettings::given, &GivenSocket::socket>},
    {"used-socket", "Socket in use; NULL when stopped", UsedSocket<GstLidarEcnUdpSrc>},
    {"stats", "packets-received, bytes-received [bytes], packets-ce, dropped-by-kernel", Stats},
}};

static void ConfigureBuffer(GstLidarEcnUdpSrc* self, int fd, guint wanted) {
  const guint granted = lidar::net::SetReceiveBuffer(fd, wanted > 0 ? wanted : kDefaultBuffer);
  GST_DEBUG_OBJECT(self, "receive buffer of %u bytes", granted);
  if (wanted == 0 || granted >= wanted) return;
  GST_ELEMENT_WARNING(
      self, RESOURCE, SETTINGS,
      ("The kernel granted a receive buffer of %u bytes instead of %u.", granted, wanted),
      ("raise it with: sysctl -w net.core.rmem_max=%u", wanted));
}

static gboolean Start(GstBaseSrc* base) {
  auto* self = GST_LIDAR_ECN_UDP_SRC(base);
  State& state = StateOf(self);
  const SrcSettings s = Snapshot(state);
  SocketInUse used =
      TakeSocket(s.given, [&] { return OpenListening(GST_ELEMENT(self), s.listen); });
  if (!used.socket) return FALSE;
  const int fd = g_socket_get_fd(used.socket.get());
  lidar::net::AskForInfo(fd);
  ConfigureBuffer(self, fd, s.options.buffer_size);
  state.wake.Clear();
  state.batch.ForgetDrops();
  state.timeout_ns = s.options.timeout.count() > 0 ? s.options.timeout.count() : -1;
  state.last_from = {};
  state.last_address.reset();
  const std::lock_guard lock(state.mutex);
  state.used = std::move(used);
  state.counters = {};
  return TRUE;
}

static gboolean Stop(GstBaseSrc* base) {
  State& state = StateOf(base);
  std::lock_guard lock(state.mutex);
  state.used.Close(state.settings.given.close);
  state.received.clear();
  return TRUE;
}

/// Returns the running time at which the datagram reached the kernel.
static GstClockTime ArrivalRunningTime(GstLidarEcnUdpSrc* self, GstClockTime arrival) {
  GstClock* clock = gst_element_get_clock(GST_ELEMENT(self));
  if (clock == nullptr) return GST_CLOCK_TIME_NONE;
  GstClockTime now = gst_clock_get_time(clock);
  gst_object_unref(clock);
  const GstClockTime base_time = gst_element_get_base_time(GST_ELEMENT(self));
  now = now > base_time ? now - base_time : 0;
  const auto unix_now = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
  const bool plausible = GST_CLOCK_TIME_IS_VALID(arrival) && arrival < unix_now &&
                         unix_now - arrival < GST_SECOND;  // otherwise the system clock was set
  const GstClockTime age = plausible ? unix_now - arrival : 0;
  return now > age ? now - age : 0;
}

static GstBuffer* ToBuffer(GstLidarEcnUdpSrc* self, const ReceivedDatagram& d) {
  State& state = StateOf(self);
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, d.size, nullptr);
  gst_buffer_fill(buffer, 0, d.data, d.size);
  GST_BUFFER_PTS(buffer) = GST_BUFFER_DTS(buffer) = ArrivalRunningTime(self, d.arrival);
  if (!state.last_address || state.last_from != *d.from) {
    state.last_from = *d.from;
    state.last_address.reset(FromNative(*d.from));
  }
  if (state.last_address) gst_buffer_add_net_address_meta(buffer, state.last_address.get());
  gst_lidar_buffer_set_ecn(buffer, static_cast<GstLidarEcn>(d.tos & 3), d.arrival);
  std::lock_guard lock(state.mutex);
  ++state.counters.packets;
  state.counters.bytes += d.size;
  if ((d.tos & 3) == GST_LIDAR_ECN_CE) ++state.counters.ce;
  return buffer;
}

static void PostTimeout(GstLidarEcnUdpSrc* self) {
  const auto timeout = static_cast<guint64>(StateOf(self).timeout_ns);
  gst_element_post_message(
      GST_ELEMENT(self), gst_message_new_element(
                             GST_OBJECT(self), gst_structure_new("GstEcnUdpSrcTimeout", "timeout",
                                                                 G_TYPE_UINT64, timeout, nullptr)));
}

/// Waits for datagrams, and receives all that are available, up to a batch.
static GstFlowReturn ReceiveBatch(GstLidarEcnUdpSrc* self) {
  State& state = StateOf(self);
  const int fd = g_socket_get_fd(state.used.socket.get());
  for (;;) {
    const int n = state.batch.Receive(fd, [&](const ReceivedDatagram& d) {
      // An empty datagram carries no data and is ignored.
      if (d.size > 0) state.received.emplace_back(ToBuffer(self, d));
    });
    if (!state.received.empty()) {
      GST_LOG_OBJECT(self, "received %" G_GSIZE_FORMAT " datagrams", state.received.size());
      return GST_FLOW_OK;
    }
    if (n < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR &&
        errno != ECONNREFUSED) {
      GST_ELEMENT_ERROR(self, RESOURCE, READ, ("Receiving failed: %s.", g_strerror(errno)),
                        (nullptr));
      return GST_FLOW_ERROR;
    }
    switch (state.wake.Wait(fd, POLLIN, state.timeout_ns)) {
      case WakeFd::Outcome::kWoken:
        return GST_FLOW_FLUSHING;
      case WakeFd::Outcome::kTimeout:
        PostTimeout(self);
        break;
      case WakeFd::Outcome::kReady:
      case WakeFd::Outcome::kError:
        break;
    }
  }
}

/// Returns a single buffer. GstBaseSrc 1.22 accepts buffer lists, too, but if it stops with a list,
/// it releases a wrong buffer.
static GstFlowReturn Create(GstPushSrc* push, GstBuffer** out) {
  auto* self = GST_LIDAR_ECN_UDP_SRC(push);
  State& state = StateOf(self);
  if (state.received.empty()) {
    const GstFlowReturn flow = ReceiveBatch(self);
    if (flow != GST_FLOW_OK) return flow;
    std::lock_guard lock(state.mutex);
    state.counters.kernel_drops = state.batch.kernel_drops();
  }
  *out = state.received.front().release();
  state.received.pop_front();
  return GST_FLOW_OK;
}

static SharedCaps CapsOf(GstBaseSrc* base) {
  State& state = StateOf(base);
  const std::lock_guard lock(state.mutex);
  return state.settings.options.caps;
}

static GstCaps* GetCaps(GstBaseSrc* base, GstCaps* filter) {
  const SharedCaps own = CapsOf(base);
  const CapsPtr caps(own ? gst_caps_ref(own.get()) : gst_caps_new_any());
  if (filter == nullptr) return gst_caps_ref(caps.get());
  return gst_caps_intersect_full(filter, caps.get(), GST_CAPS_INTERSECT_FIRST);
}

/// Returns fixed caps that downstream accepts, or null if downstream accepts any caps.
static GstCaps* FixateForPeer(const GstCaps* peer) {
  if (gst_caps_is_any(peer) || gst_caps_is_empty(peer)) return nullptr;
  GstCaps* caps = gst_caps_truncate(gst_caps_copy(peer));
  GstStructure* s = gst_caps_get_structure(caps, 0);
  if (gst_structure_has_field(s, "payload")) {
    gst_structure_fixate_field_nearest_int(s, "payload", kDefaultPayload);
  } else if (gst_structure_has_field(s, "encoding-name")) {
    gst_structure_set(s, "payload", G_TYPE_INT, kDefaultPayload, nullptr);
  }
  return gst_caps_fixate(caps);
}

static gboolean Negotiate(GstBaseSrc* base) {
  CapsPtr caps;
  if (const SharedCaps own = CapsOf(base)) {
    caps.reset(gst_caps_fixate(gst_caps_copy(own.get())));
  } else {
    const CapsPtr peer(gst_pad_peer_query_caps(GST_BASE_SRC_PAD(base), nullptr));
    caps.reset(FixateForPeer(peer.get()));
  }
  return !caps || gst_base_src_set_caps(base, caps.get());
}

static void gst_lidar_ecn_udp_src_init(GstLidarEcnUdpSrc* self) {
  self->state = new State;
  gst_base_src_set_live(GST_BASE_SRC(self), TRUE);
  gst_base_src_set_format(GST_BASE_SRC(self), GST_FORMAT_TIME);
}

static void InstallVmethods(GstLidarEcnUdpSrcClass* klass) {
  auto* src = GST_BASE_SRC_CLASS(klass);
  src->start = Start;
  src->stop = Stop;
  src->get_caps = GetCaps;
  src->negotiate = Negotiate;
  WakeOnUnlock<GstLidarEcnUdpSrc, GstBaseSrc>(src);
  GST_PUSH_SRC_CLASS(klass)->create = Create;
}

static void gst_lidar_ecn_udp_src_class_init(GstLidarEcnUdpSrcClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_ecn_udp_src_debug, "ecnudpsrc", 0, "UDP source with ECN");
  ServeState<GstLidarEcnUdpSrc, gst_lidar_ecn_udp_src_parent_class, kProperties>(klass);
  Describe(klass,
           {"UDP source with ECN", "Source/Network", "Receives datagrams with their ECN field"},
           {{"src", GST_PAD_SRC, "ANY"}});
  InstallVmethods(klass);
}
