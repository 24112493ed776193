// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds out which slices have arrived, from the sequence numbers of the packets that have arrived.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace lidar::rtp {

/// The recent packets of an SSRC and their slices. The memory is bounded: if there are too many
/// packets without acknowledgement, the oldest are dropped.
class Delivery {
 public:
  struct Slice {
    std::uint32_t scan_id = 0;
    std::uint32_t index = 0;
  };
  struct Packet {
    std::uint32_t ssrc = 0;
    std::uint16_t seq = 0;
    Slice slice;
    bool ends_slice = false;
  };

  /// Notes that a packet was sent. Must be called in the order of sending.
  void OnSent(const Packet& packet);
  /// Notes that the receiver has the packets from `first` to `last`. Returns the slices that have
  /// become complete by this.
  std::vector<Slice> OnReceived(std::uint32_t ssrc, std::uint16_t first, std::uint16_t last);

  static constexpr std::size_t kMostPackets = 8'192;

 private:
  struct SentPacket {
    std::uint64_t slice;  // number of the packet's slice
    bool received = false;
  };
  struct SentSlice {
    Slice name;
    std::size_t missing = 0;
    bool ended = false;
  };
  void Forget();
  void DropFirst();

  std::optional<std::uint32_t> ssrc_;
  std::uint16_t first_seq_ = 0;
  std::deque<SentPacket> packets_;
  std::uint64_t first_slice_ = 0;  // number of the first slice in slices_
  std::deque<SentSlice> slices_;
};

}  // namespace lidar::rtp
