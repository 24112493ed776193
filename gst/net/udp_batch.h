// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends and receives many datagrams per system call, each with its own ECN codepoint (sendmmsg,
// recvmmsg and cmsg).
#pragma once
#include <gst/gst.h>
#include <sys/uio.h>

#include <array>
#include <functional>
#include <vector>

#include "gst/net/udp_socket.h"

namespace lidar::gst {

/// Collects datagrams and sends them together. The buffers stay mapped from Add() to Flush(). The
/// caller owns the buffers and must keep them until then.
class UdpBatchSender {
 public:
  static constexpr std::size_t kCapacity = 64;

  struct Result {
    guint packets = 0;
    guint64 bytes = 0;
    guint errors = 0;    // datagrams given up
    int last_errno = 0;  // of the last error
    bool woken = false;  // the remainder was given up because of WakeFd
  };

  UdpBatchSender();
  ~UdpBatchSender() { Clear(); }
  UdpBatchSender(const UdpBatchSender&) = delete;
  UdpBatchSender& operator=(const UdpBatchSender&) = delete;

  bool full() const { return count_ == kCapacity; }
  /// Adds a datagram. `tos` has the DSCP and ECN bits of the IP header. `interface` is the index of
  /// the interface through which the datagram is sent, or 0. Returns false if the buffer cannot be
  /// mapped.
  bool Add(GstBuffer* buffer, guint8 tos, const NativeAddress& to, unsigned interface = 0);
  /// Sends all datagrams, and then removes them. Waits for the socket if necessary.
  Result Flush(int fd, const WakeFd& wake);

 private:
  static constexpr std::size_t kMaxMemories = 4;
  struct Message {
    std::array<iovec, kMaxMemories> iov;
    std::array<GstMapInfo, kMaxMemories> maps;
    guint memories = 0;
    GstBuffer* merged = nullptr;  // a buffer with too many memories, which is mapped as a whole
    NativeAddress to;
    net::SendControl control;
  };

  bool Map(Message& m, GstBuffer* buffer);
  void Clear();

  std::vector<Message> messages_;
  std::vector<mmsghdr> headers_;
  std::size_t count_ = 0;
};

/// A datagram, and the data that the kernel attaches to it.
struct ReceivedDatagram {
  const guint8* data = nullptr;  // valid only during the call of `consume`
  gsize size = 0;
  guint8 tos = 0;
  GstClockTime arrival = GST_CLOCK_TIME_NONE;  // kernel time [ns since the Unix epoch]
  const NativeAddress* from = nullptr;
};

class UdpBatchReceiver {
 public:
  static constexpr std::size_t kCapacity = 32;
  static constexpr std::size_t kMaxDatagram = 65536;

  UdpBatchReceiver();
  /// Receives the datagrams that are available, and calls `consume` for each. Returns their number,
  /// or -1 with errno set. Call net::AskForInfo() on `fd` before.
  int Receive(int fd, const std::function<void(const ReceivedDatagram&)>& consume);
  /// Returns the number of datagrams that the kernel has dropped because the buffer was full, since
  /// the socket was opened.
  guint kernel_drops() const { return kernel_drops_; }
  /// Resets the count for another socket. The kernel would not reset it, because it reports no
  /// count before its first drop.
  void ForgetDrops() { kernel_drops_ = 0; }

 private:
  struct Slot {
    iovec iov{};
    NativeAddress from;
    alignas(cmsghdr) std::array<char, 256> control;
  };
  ReceivedDatagram Read(std::size_t i);

  std::vector<guint8> arena_;
  std::vector<Slot> slots_;
  std::vector<mmsghdr> headers_;
  guint kernel_drops_ = 0;
};

}  // namespace lidar::gst
