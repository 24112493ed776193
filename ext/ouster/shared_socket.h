// SPDX-License-Identifier: LGPL-2.1-or-later
// UDP sockets that the sources of one process share, since the kernel gives a unicast datagram to
// one socket only: several sensors may send to one port.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "gst/net/udp_batch.h"
#include "gst/net/udp_socket.h"

namespace lidar::gst {

/// Readers that ask for the same place share its socket.
struct SocketPlace {
  std::string address;  // local; empty: any
  guint port = 0;
  std::string group;      // multicast; may be empty
  std::string interface;  // of the group; empty: the kernel's choice

  bool operator<(const SocketPlace& o) const {
    return std::tie(address, port, group, interface) <
           std::tie(o.address, o.port, o.group, o.interface);
  }
};

class SharedSocket;

/// A reader of a socket; every reader gets every datagram in the order of arrival. Receive() reads
/// the socket and leaves copies for the other readers, so no extra thread is needed and a lone
/// reader copies nothing. For one thread.
class SocketReader {
 public:
  /// `queue_bytes` bounds the reader's queue, and the kernel's buffer of the socket; 0: the
  /// kernel's default. Returns null and `error` if the socket cannot be opened.
  static std::unique_ptr<SocketReader> Open(const SocketPlace& place, guint queue_bytes,
                                            GError** error);
  ~SocketReader();
  SocketReader(const SocketReader&) = delete;
  SocketReader& operator=(const SocketReader&) = delete;

  /// Descriptors to wait for: at least one is readable while Receive() may find datagrams.
  int socket_fd() const;
  int queue_fd() const { return queued_.fd(); }
  /// Gives the datagrams to `consume`; returns false with errno set if the socket failed.
  bool Receive(const std::function<void(const ReceivedDatagram&)>& consume);

  guint granted_buffer() const { return granted_buffer_; }  // bytes
  /// Number of datagrams lost because the socket's buffer, or the queue here, was full.
  guint64 drops() const { return kernel_drops_ + queue_drops_; }

 private:
  friend class SharedSocket;
  struct Copy {
    std::vector<guint8> bytes;
    NativeAddress from;
    ReceivedDatagram datagram;
  };
  SocketReader(SocketPlace place, guint queue_bytes)
      : place_(std::move(place)), queue_bytes_(queue_bytes) {}
  void Enqueue(const ReceivedDatagram& datagram);

  const SocketPlace place_;
  const guint queue_bytes_;
  SharedSocket* socket_ = nullptr;
  guint granted_buffer_ = 0;
  UdpBatchReceiver batch_;
  std::vector<Copy> taken_;
  std::vector<ReceivedDatagram> arrived_;
  guint64 drops_before_ = 0;  // kernel's count when this reader was opened
  guint64 kernel_drops_ = 0;
  guint64 queue_drops_ = 0;

  // Guarded by the socket's mutex.
  std::vector<Copy> queue_;
  gsize queued_bytes_ = 0;
  guint64 queue_overflows_ = 0;
  WakeFd queued_;
};

}  // namespace lidar::gst
