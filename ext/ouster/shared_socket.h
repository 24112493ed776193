// SPDX-License-Identifier: LGPL-2.1-or-later
// UDP sockets that all sources of a process share. Several sensors may send to the same port, but
// the kernel passes a unicast datagram to only one socket.
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

/// The addresses that a socket is bound to. Readers that ask for the same place share one socket.
struct SocketPlace {
  std::string address;  // local address; empty for any
  guint port = 0;
  std::string group;      // multicast group; may be empty
  std::string interface;  // interface for the group; empty: chosen by the kernel

  bool operator<(const SocketPlace& o) const {
    return std::tie(address, port, group, interface) <
           std::tie(o.address, o.port, o.group, o.interface);
  }
};

class SharedSocket;

/// A reader of a shared socket. Every reader gets every datagram, in the order of arrival.
/// Receive() reads from the socket and puts copies into the queues of all other readers. So no
/// extra thread is needed, and if there is only one reader, nothing is copied. A reader is used by
/// one thread.
class SocketReader {
 public:
  /// Opens a reader. `queue_bytes` is the limit of the reader's queue and the size of the socket's
  /// receive buffer; 0 for the kernel's default. Returns null and sets `error` if the socket cannot
  /// be opened.
  static std::unique_ptr<SocketReader> Open(const SocketPlace& place, guint queue_bytes,
                                            GError** error);
  ~SocketReader();
  SocketReader(const SocketReader&) = delete;
  SocketReader& operator=(const SocketReader&) = delete;

  /// The file descriptors to wait for. At least one of the two is readable while Receive() may find
  /// datagrams.
  int socket_fd() const;
  int queue_fd() const { return queued_.fd(); }
  /// Passes all available datagrams to `consume`. If the socket failed, returns false and sets
  /// errno.
  bool Receive(const std::function<void(const ReceivedDatagram&)>& consume);

  guint granted_buffer() const { return granted_buffer_; }  // bytes
  /// Returns the number of datagrams that were lost because the socket's buffer or the reader's
  /// queue was full.
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
  guint64 drops_before_ = 0;  // the socket's kernel_drops_ when this reader was opened
  guint64 kernel_drops_ = 0;
  guint64 queue_drops_ = 0;

  // The members below are guarded by the mutex of the socket.
  std::vector<Copy> queue_;
  gsize queued_bytes_ = 0;
  guint64 queue_overflows_ = 0;
  WakeFd queued_;
};

}  // namespace lidar::gst
