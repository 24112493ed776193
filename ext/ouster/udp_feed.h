// SPDX-License-Identifier: LGPL-2.1-or-later
// The sockets on which a sensor's packets arrive.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <memory>
#include <string>

#include "ext/ouster/settings.h"
#include "ext/ouster/shared_socket.h"

namespace lidar::gst {

/// Only one thread may use this class, except for Wake() and ClearWake(), which any thread may
/// call.
class UdpFeed {
 public:
  UdpFeed();
  ~UdpFeed();
  UdpFeed(const UdpFeed&) = delete;
  UdpFeed& operator=(const UdpFeed&) = delete;

  struct Ports {
    guint lidar = 0;
    guint imu = 0;  // 0 for no IMU
  };
  struct Opened {
    guint granted_buffer = 0;  // bytes
    std::string error;         // a text for the user; empty on success
    // A text for the user. If it is not empty, only the lidar's socket is open.
    std::string imu_error;
  };
  /// Opens the sockets and joins the multicast group. Closes all sockets that were open before.
  Opened Open(const OusterSettings& settings, const Ports& ports);
  bool IsOpen(const Ports& ports) const;
  void Close();
  /// Returns the port of the lidar packets, or 0 while the feed is closed.
  guint port() const { return lidar_ ? ports_.lidar : 0; }

  enum class Outcome { kPackets, kTimeout, kWoken, kError };
  /// Waits for datagrams and passes each of them to `consume`. The bytes of a datagram are valid
  /// only during the call of `consume`. While the feed is closed, waits only for Wake().
  Outcome Receive(gint64 timeout_ns, const std::function<void(const ReceivedDatagram&)>& consume);
  /// Makes Receive() return kWoken until ClearWake() is called.
  void Wake() { wake_.Wake(); }
  void ClearWake() { wake_.Clear(); }

  /// Returns the number of datagrams lost by the lidar's socket and by the sockets that it
  /// replaced.
  guint64 drops() const { return drops_before_ + (lidar_ ? lidar_->drops() : 0); }

 private:
  using ReaderPtr = std::unique_ptr<SocketReader>;

  bool WaitFor(const SocketReader& reader) const;

  Ports ports_;
  ReaderPtr lidar_;
  ReaderPtr imu_;
  guint64 drops_before_ = 0;
  int epoll_;  // epoll descriptor for both sockets
  WakeFd wake_;
};

}  // namespace lidar::gst
