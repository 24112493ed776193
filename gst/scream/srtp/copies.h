// SPDX-License-Identifier: LGPL-2.1-or-later
// Copies of accepted datagrams that arrive over other links of the sender.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

#include "gst/common/refs.h"
#include "gst/net/udp_socket.h"

namespace lidar::gst {

/// A sender protects a packet once and sends the same bytes over all its links. srtpdec refuses the
/// copies as replays, but the receiver needs each copy to judge the links. This class therefore
/// recognises the bytes of an accepted datagram, and accepts them once from each other address.
class SrtpCopies {
 public:
  static constexpr std::size_t kMaxDatagrams = 1'024;
  static constexpr std::size_t kMaxBytes = 2 << 20;
  static constexpr std::size_t kMaxAddresses = 4;  // for one datagram

  /// Call it for each RTP datagram. Until a second address sends, no copies are expected, and
  /// OnPassed() stores nothing.
  void OnArrival(GstBuffer* datagram);
  /// Call it after `datagram` was accepted. `decoded` is the decoded packet.
  void OnPassed(GstBuffer* datagram, GstBuffer* decoded);
  /// Returns the decoded packet if `datagram` is a copy from another address, else NULL. The packet
  /// has the address, ECN marks and times of the copy.
  BufferPtr Take(GstBuffer* datagram);
  void Clear();

 private:
  struct Passed {
    std::uint64_t digest = 0;
    BufferPtr decoded;
    std::vector<SocketAddressPtr> addresses;
  };

  SocketAddressPtr last_;  // of the last datagram
  bool several_ = false;
  std::unordered_map<std::uint64_t, Passed> passed_;  // by SSRC and sequence number
  std::deque<std::uint64_t> order_;
  std::size_t bytes_ = 0;
};

}  // namespace lidar::gst
