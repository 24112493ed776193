// SPDX-License-Identifier: LGPL-2.1-or-later
#include "udp_feed.h"

#include <poll.h>
#include <sys/socket.h>

#include <cerrno>

#include "common/refs.h"

namespace lidar::gst {
namespace {

/// The largest receive buffer up to `bytes` that the kernel grants.
guint SetReceiveBuffer(int fd, guint bytes) {
  const int size = static_cast<int>(bytes);
  // The forced form needs CAP_NET_ADMIN.
  if (bytes > 0 && setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &size, sizeof size) != 0 &&
      setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &size, sizeof size) != 0)
    return 0;
  int granted = 0;
  socklen_t length = sizeof granted;
  if (getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &granted, &length) != 0) return 0;
  return static_cast<guint>(granted / 2);  // the kernel doubles it for its own bookkeeping
}

std::string Explain(const GError& error, guint port) {
  std::string text = "Cannot receive on UDP port " + std::to_string(port) + ": " + error.message;
  if (g_error_matches(&error, G_IO_ERROR, G_IO_ERROR_ADDRESS_IN_USE))
    text +=
        "; another program (or another ouster_src) receives there: stop it, or give each its "
        "own lidar-port and point the sensor's udp_port_lidar at it";
  return text;
}

}  // namespace

UdpFeed::UdpFeed() = default;
UdpFeed::~UdpFeed() { Close(); }

UdpFeed::Opened UdpFeed::Open(const OusterSettings& settings, guint port) {
  const std::string& group = settings.multicast_group;
  UdpBind bind{settings.address, port, G_SOCKET_FAMILY_INVALID, !group.empty()};
  if (!group.empty())
    bind.family =
        group.find(':') != std::string::npos ? G_SOCKET_FAMILY_IPV6 : G_SOCKET_FAMILY_IPV4;
  GError* raw_error = nullptr;
  SocketPtr socket(OpenUdpSocket(bind, &raw_error));
  if (socket && !group.empty())
    JoinMulticast(socket.get(), group, settings.multicast_iface, &raw_error);
  const ErrorPtr error(raw_error);
  if (error) return {false, 0, Explain(*error, port)};
  const int fd = g_socket_get_fd(socket.get());
  UdpBatchReceiver::Prepare(fd);
  const guint granted = SetReceiveBuffer(fd, settings.buffer_size);
  lidar_ = std::move(socket);
  return {true, granted, {}};
}

void UdpFeed::Close() { lidar_.reset(); }

guint UdpFeed::port() const {
  if (!lidar_) return 0;
  const std::unique_ptr<GSocketAddress, GObjectUnref> local(
      g_socket_get_local_address(lidar_.get(), nullptr));
  return local ? g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(local.get())) : 0;
}

UdpFeed::Outcome UdpFeed::Receive(gint64 timeout_ns,
                                  const std::function<void(const ReceivedDatagram&)>& consume) {
  const int fd = g_socket_get_fd(lidar_.get());
  switch (wake_.Wait(fd, POLLIN, timeout_ns)) {
    case WakeFd::Outcome::kWoken:
      return Outcome::kWoken;
    case WakeFd::Outcome::kTimeout:
      return Outcome::kTimeout;
    case WakeFd::Outcome::kError:
      return Outcome::kError;
    case WakeFd::Outcome::kReady:
      break;
  }
  const int n = batch_.Receive(fd, consume);
  const bool transient =
      n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == ECONNREFUSED);
  return n >= 0 || transient ? Outcome::kPackets : Outcome::kError;
}

}  // namespace lidar::gst
