// SPDX-License-Identifier: LGPL-2.1-or-later
// The fragments of one unit, ordered by their RTP sequence numbers.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "src/rtp/payload_header.h"

namespace lidar::rtp {

class FragmentBuffer {
 public:
  enum class Added { kStored, kDuplicate, kContradiction };

  /// Stores a copy of the body of a fragment.
  Added Add(std::uint16_t sequence, const Unit& unit);
  /// Returns true if all fragments from the first to the last have arrived.
  bool IsWhole() const;
  /// Returns the bytes of the unit, or nothing if their number or CRC is wrong. Requires IsWhole().
  std::optional<std::vector<std::uint8_t>> Join() const;
  /// Returns the first fragment without its body, or null before it arrives.
  const Unit* start() const { return start_ ? &*start_ : nullptr; }
  std::optional<std::uint16_t> start_sequence() const;
  /// Returns about how much memory the fragments take [bytes].
  std::size_t cost() const { return cost_; }

 private:
  void Drop(std::map<int, std::vector<std::uint8_t>>::iterator from,
            std::map<int, std::vector<std::uint8_t>>::iterator to);

  std::map<int, std::vector<std::uint8_t>> fragments_;  // by distance from base_
  std::optional<std::uint16_t> base_;                   // of the fragment that arrived first
  std::optional<int> first_;
  std::optional<int> last_;
  std::optional<Unit> start_;
  std::size_t cost_ = 0;
};

}  // namespace lidar::rtp
