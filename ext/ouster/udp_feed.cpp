// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/udp_feed.h"

#include <poll.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <cerrno>

#include "gst/common/refs.h"

namespace lidar::gst {
namespace {

std::string Explain(const GError& error, guint port) {
  std::string text = "Cannot receive on UDP port " + std::to_string(port) + ": " + error.message;
  if (g_error_matches(&error, G_IO_ERROR, G_IO_ERROR_ADDRESS_IN_USE))
    text +=
        "; another program receives on this port, or an ouster_src with another address or "
        "multicast-group: stop it, set another lidar-port (with hostname, it is also set on the "
        "sensor), or let the sensor send to a multicast-group";
  return text;
}

/// Opens the socket of `port` with the settings. If it fails, returns null and sets `why` to a text
/// for the user.
std::unique_ptr<SocketReader> OpenReader(const OusterSettings& settings, guint port,
                                         std::string* why) {
  GError* raw_error = nullptr;
  auto reader = SocketReader::Open(
      {settings.address, port, settings.multicast_group, settings.multicast_iface},
      settings.buffer_size, &raw_error);
  const ErrorPtr error(raw_error);
  if (!reader) *why = Explain(*error, port);
  return reader;
}

}  // namespace

UdpFeed::UdpFeed() : epoll_(epoll_create1(EPOLL_CLOEXEC)) {}

UdpFeed::~UdpFeed() {
  Close();
  if (epoll_ >= 0) close(epoll_);
}

bool UdpFeed::WaitFor(const SocketReader& reader) const {
  for (const int fd : {reader.socket_fd(), reader.queue_fd()}) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = fd;
    if (epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event) != 0) return false;
  }
  return true;
}

UdpFeed::Opened UdpFeed::Open(const OusterSettings& settings, const Ports& ports) {
  Close();
  Opened opened;
  ports_ = ports;
  lidar_ = OpenReader(settings, ports.lidar, &opened.error);
  if (!lidar_) return opened;
  if (ports.imu != 0 && ports.imu != ports.lidar)
    imu_ = OpenReader(settings, ports.imu, &opened.imu_error);
  opened.granted_buffer = lidar_->granted_buffer();
  if (!WaitFor(*lidar_) || (imu_ && !WaitFor(*imu_)))
    opened.error = std::string("Cannot wait for packets: ") + g_strerror(errno);
  return opened;
}

bool UdpFeed::IsOpen(const Ports& ports) const {
  return lidar_ && ports.lidar == ports_.lidar && ports.imu == ports_.imu;
}

void UdpFeed::Close() {
  // Closing a reader does not close its socket if other readers still use it. The socket must
  // therefore be removed from the epoll set.
  for (const ReaderPtr* reader : {&lidar_, &imu_})
    if (*reader)
      for (const int fd : {(*reader)->socket_fd(), (*reader)->queue_fd()})
        if (epoll_ctl(epoll_, EPOLL_CTL_DEL, fd, nullptr) != 0) continue;
  drops_before_ = drops();
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
  const bool transient = lidar_->Receive(consume) || errno == EAGAIN || errno == EWOULDBLOCK ||
                         errno == EINTR || errno == ECONNREFUSED;
  if (!transient) return Outcome::kError;
  if (imu_) imu_->Receive(consume);
  return Outcome::kPackets;
}

}  // namespace lidar::gst
