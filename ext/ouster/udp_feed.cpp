// SPDX-License-Identifier: LGPL-2.1-or-later
#include "udp_feed.h"

#include <poll.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

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

UdpFeed::UdpFeed() : epoll_(epoll_create1(EPOLL_CLOEXEC)) {}

UdpFeed::~UdpFeed() {
  Close();
  if (epoll_ >= 0) close(epoll_);
}

UdpFeed::SocketPtr UdpFeed::OpenOne(const OusterSettings& settings, guint port,
                                    std::string* error) {
  const std::string& group = settings.multicast_group;
  UdpBind bind{settings.address, port, G_SOCKET_FAMILY_INVALID, !group.empty()};
  if (!group.empty())
    bind.family =
        group.find(':') != std::string::npos ? G_SOCKET_FAMILY_IPV6 : G_SOCKET_FAMILY_IPV4;
  GError* raw_error = nullptr;
  SocketPtr socket(OpenUdpSocket(bind, &raw_error));
  if (socket && !group.empty())
    JoinMulticast(socket.get(), group, settings.multicast_iface, &raw_error);
  const ErrorPtr problem(raw_error);
  if (problem) {
    *error = Explain(*problem, port);
    return nullptr;
  }
  UdpBatchReceiver::Prepare(g_socket_get_fd(socket.get()));
  return socket;
}

UdpFeed::Opened UdpFeed::Open(const OusterSettings& settings, const Ports& ports) {
  Close();
  Opened opened;
  ports_ = ports;
  lidar_ = OpenOne(settings, ports.lidar, &opened.error);
  if (!lidar_) return opened;
  if (ports.imu != 0 && ports.imu != ports.lidar)
    imu_ = OpenOne(settings, ports.imu, &opened.imu_error);
  opened.granted_buffer = SetReceiveBuffer(g_socket_get_fd(lidar_.get()), settings.buffer_size);
  for (const SocketPtr* socket : {&lidar_, &imu_}) {
    if (!*socket) continue;
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = g_socket_get_fd(socket->get());
    if (epoll_ctl(epoll_, EPOLL_CTL_ADD, event.data.fd, &event) != 0)
      opened.error = std::string("Cannot wait for packets: ") + g_strerror(errno);
  }
  return opened;
}

bool UdpFeed::IsOpen(const Ports& ports) const {
  return lidar_ && ports.lidar == ports_.lidar && ports.imu == ports_.imu;
}

void UdpFeed::Close() {
  // Closing takes a socket out of the epoll set.
  lidar_.reset();
  imu_.reset();
}

UdpFeed::Outcome UdpFeed::Receive(gint64 timeout_ns,
                                  const std::function<void(const ReceivedDatagram&)>& consume) {
  switch (wake_.Wait(lidar_ ? epoll_ : -1, POLLIN, timeout_ns)) {
    case WakeFd::Outcome::kWoken:
      return Outcome::kWoken;
    case WakeFd::Outcome::kTimeout:
      return Outcome::kTimeout;
    case WakeFd::Outcome::kError:
      return Outcome::kError;
    case WakeFd::Outcome::kReady:
      break;
  }
  if (!lidar_) return Outcome::kTimeout;
  const int n = batch_.Receive(g_socket_get_fd(lidar_.get()), consume);
  const bool transient =
      n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == ECONNREFUSED);
  if (n < 0 && !transient) return Outcome::kError;
  if (imu_) imu_batch_.Receive(g_socket_get_fd(imu_.get()), consume);
  return Outcome::kPackets;
}

}  // namespace lidar::gst
