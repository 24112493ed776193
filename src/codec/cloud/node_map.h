// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the nodes in one level of a tree by their positions.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/codec/cloud/cell_list.h"

namespace lidar::codec::cloud {

/// An open hash table. It grows, so that it is never more than half full. The hash depends on the
/// address of the table: for a known hash, an attacker could craft a cloud whose cells all collide.
class NodeMap {
 public:
  static constexpr std::uint32_t kAbsent = UINT32_MAX;

  void Reset(std::size_t nodes) {
    unsigned bits = 4;
    while (std::size_t{1} << bits < 2 * nodes) ++bits;
    shift_ = 64 - bits;
    slots_.assign(std::size_t{1} << bits, {0, kAbsent});
    room_ = slots_.size() / 2;
    const std::uint64_t address = reinterpret_cast<std::uintptr_t>(slots_.data());
    salt_ = address * kMultiplier;
  }
  void Add(std::uint64_t key, std::uint32_t index) {
    if (room_ == 0) Grow();
    --room_;
    std::size_t at = SlotOf(key);
    while (slots_[at].index != kAbsent) at = (at + 1) & (slots_.size() - 1);
    slots_[at] = {key, index};
  }
  std::uint32_t Find(std::uint64_t key) const {
    for (std::size_t at = SlotOf(key);; at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at].index == kAbsent || slots_[at].key == key) return slots_[at].index;
    }
  }

  static constexpr std::uint64_t kStepX = std::uint64_t{1} << 42;
  static constexpr std::uint64_t kStepY = std::uint64_t{1} << 21;
  static constexpr std::uint64_t kStepZ = 1;
  /// Returns the key of a position. The key has the coordinates plus 1, so that neighbours of
  /// position 0 have keys, too.
  ///
  /// Each coordinate has a field of 21 bits. This suffices even in a tree of kMostDepth, because
  /// DepthFor() leaves the cells at the edge of a tree empty.
  static std::uint64_t KeyOf(const CellPosition& p) {
    return (p[0] + 1) * kStepX + (p[1] + 1) * kStepY + (p[2] + 1) * kStepZ;
  }
  static CellPosition PositionOf(std::uint64_t key) {
    constexpr std::uint64_t kField = kStepY - 1;
    return {static_cast<std::uint32_t>(key / kStepX - 1),
            static_cast<std::uint32_t>((key / kStepY & kField) - 1),
            static_cast<std::uint32_t>((key & kField) - 1)};
  }

 private:
  void Grow() {
    std::vector<Slot> old;
    old.swap(slots_);
    Reset(old.size());
    for (const Slot& slot : old)
      if (slot.index != kAbsent) Add(slot.key, slot.index);
  }
  struct Slot {
    std::uint64_t key;
    std::uint32_t index;
  };
  std::size_t SlotOf(std::uint64_t key) const {
    return static_cast<std::size_t>((key ^ salt_) * kMultiplier >> shift_);
  }

  static constexpr std::uint64_t kMultiplier = 0x9E3779B97F4A7C15U;

  std::uint64_t salt_ = 0;
  std::vector<Slot> slots_;
  std::size_t room_ = 0;
  unsigned shift_ = 60;
};

}  // namespace lidar::codec::cloud
