// SPDX-License-Identifier: LGPL-2.1-or-later
// The fragments of one unit, put in order by their RTP sequence numbers.
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

  /// Stores a copy of the unit's body.
  Added Add(std::uint16_t sequence, const Unit& unit);
  /// Are all fragments from the first to the last there?
  bool IsWhole() const;
  /// The whole unit's bytes, which are as many and as they were sent, or none. IsWhole() only.
  std::optional<std::vector<std::uint8_t>> Join() const;
  /// The unit's first packet, without its body; null before it came.
  const Unit* start() const { return start_ ? &*start_ : nullptr; }
  std::optional<std::uint16_t> start_sequence() const;
  /// Memory that the fragments hold, roughly [bytes].
  std::size_t cost() const { return cost_; }

 private:
  void Drop(std::map<int, std::vector<std::uint8_t>>::iterator from,
            std::map<int, std::vector<std::uint8_t>>::iterator to);

  std::map<int, std::vector<std::uint8_t>> fragments_;  // by distance from base_
  std::optional<std::uint16_t> base_;                   // the first sequence number that came
  std::optional<int> first_;
  std::optional<int> last_;
  std::optional<Unit> start_;
  std::size_t cost_ = 0;
};

}  // namespace lidar::rtp
