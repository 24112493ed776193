// SPDX-License-Identifier: LGPL-2.1-or-later
// Copies of accepted datagrams that came by the sender's other links.
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
/// replays, but the receiver needs each copy to judge the links. So bytes that were accepted pass
/// again, once for each address.
class SrtpCopies {
 public:
  static constexpr std::size_t kMaxDatagrams = 1'024;
  static constexpr std::size_t kMaxBytes = 2 << 20;
  static constexpr std::size_t kMaxAddresses = 4;  // for one datagram

  /// Notes an RTP datagram. Keeps nothing until a second address sends.
  void OnArrival(GstBuffer* datagram);
  /// `datagram` was accepted, and decoded to `decoded`.
  void OnPassed(GstBuffer* datagram, GstBuffer* decoded);
  /// Returns the decoded packet of a refused copy, with the copy's address, marks and times; NULL
  /// if `datagram` is no copy.
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
