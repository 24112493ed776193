// SPDX-License-Identifier: LGPL-2.1-or-later
// The sockets on which a sensor's packets arrive.
#pragma once
#include <gio/gio.h>

#include <functional>
#include <memory>
#include <string>

#include "ecnudp/udp_batch.h"
#include "ecnudp/udp_socket.h"
#include "settings.h"

namespace lidar::gst {

/// Owned by one thread, except for Wake() and ClearWake().
class UdpFeed {
 public:
  UdpFeed();
  ~UdpFeed();
  UdpFeed(const UdpFeed&) = delete;
  UdpFeed& operator=(const UdpFeed&) = delete;

  struct Opened {
    bool ok = false;
    guint granted_buffer = 0;  // bytes
    std::string error;         // what to do about it, for a user
  };
  /// Binds and joins; a port of 0 takes any free one.
  Opened Open(const OusterSettings& settings, guint port);
  void Close();
  /// 0 while closed.
  guint port() const;

  enum class Outcome { kPackets, kTimeout, kWoken, kError };
  /// Waits for datagrams and hands over what is there; their bytes are valid during the call.
  Outcome Receive(gint64 timeout_ns, const std::function<void(const ReceivedDatagram&)>& consume);
  /// Makes Receive() return kWoken until ClearWake().
  void Wake() { wake_.Wake(); }
  void ClearWake() { wake_.Clear(); }

  guint kernel_drops() const { return batch_.kernel_drops(); }

 private:
  using SocketPtr = std::unique_ptr<GSocket, GObjectUnref>;

  SocketPtr lidar_;
  UdpBatchReceiver batch_;
  WakeFd wake_;
};

}  // namespace lidar::gst
