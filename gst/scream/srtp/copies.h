// SPDX-License-Identifier: LGPL-2.1-or-later
// Copies of datagrams that passed, from the other links of a sender.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

#include "gst/common/refs.h"
#include "gst/net/udp_socket.h"

namespace lidar::gst {

/// A sender protects a packet once and sends the same bytes over its links. SRTP refuses copies as
/// replays, but the receiver needs each to judge the links. Bytes that passed pass again, once for
/// each address.
class SrtpCopies {
 public:
  static constexpr std::size_t kMaxDatagrams = 1'024;
  static constexpr std::size_t kMaxBytes = 2 << 20;
  static constexpr std::size_t kMaxAddresses = 4;  // of a datagram

  /// Notes an RTP datagram. Keeps nothing until another address sends, too.
  void OnArrival(GstBuffer* datagram);
  /// `datagram` passed as `decoded`.
  void OnPassed(GstBuffer* datagram, GstBuffer* decoded);
  /// Returns the packet that a refused datagram is a copy of, with the copy's address, marks and
  /// times; else NULL.
  BufferPtr Take(GstBuffer* datagram);
  void Clear();

 private:
  struct Passed {
    std::uint64_t digest = 0;
    BufferPtr decoded;
    std::vector<SocketAddressPtr> addresses;
  };

  SocketAddressPtr last_;  // sender of the last datagram
  bool several_ = false;
  std::unordered_map<std::uint64_t, Passed> passed_;  // by SSRC and sequence number
  std::deque<std::uint64_t> order_;
  std::size_t bytes_ = 0;
};

}  // namespace lidar::gst
