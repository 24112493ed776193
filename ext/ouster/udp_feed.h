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

/// Used by one thread, except for Wake() and ClearWake().
class UdpFeed {
 public:
  UdpFeed();
  ~UdpFeed();
  UdpFeed(const UdpFeed&) = delete;
  UdpFeed& operator=(const UdpFeed&) = delete;

  struct Ports {
    guint lidar = 0;
    guint imu = 0;  // 0: none
  };
  struct Opened {
    guint granted_buffer = 0;  // bytes
    std::string error;         // for a user; empty: success
    std::string imu_error;     // for a user; then only the lidar's socket is open
  };
  /// Opens the sockets and joins the multicast group. Closes sockets that were open.
  Opened Open(const OusterSettings& settings, const Ports& ports);
  bool IsOpen(const Ports& ports) const;
  void Close();
  /// 0 while closed.
  guint port() const { return lidar_ ? ports_.lidar : 0; }

  enum class Outcome { kPackets, kTimeout, kWoken, kError };
  /// Waits for datagrams, and passes each to `consume`; its bytes are valid during that call. While
  /// the feed is closed, waits only for Wake().
  Outcome Receive(gint64 timeout_ns, const std::function<void(const ReceivedDatagram&)>& consume);
  /// Makes Receive() return kWoken until ClearWake().
  void Wake() { wake_.Wake(); }
  void ClearWake() { wake_.Clear(); }

  /// Datagrams that the lidar's socket and its predecessors lost.
  guint64 drops() const { return drops_before_ + (lidar_ ? lidar_->drops() : 0); }

 private:
  using ReaderPtr = std::unique_ptr<SocketReader>;

  bool WaitFor(const SocketReader& reader) const;

  Ports ports_;
  ReaderPtr lidar_;
  ReaderPtr imu_;
  guint64 drops_before_ = 0;
  int epoll_;  // for both sockets
  WakeFd wake_;
};

}  // namespace lidar::gst
