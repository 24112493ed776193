// SPDX-License-Identifier: LGPL-2.1-or-later
// The slices that an encoder may refer to: the newest that its receiver has acknowledged.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "src/base/time.h"
#include "src/codec/block_memory.h"

namespace lidar::codec {

/// Numbers of a slice at its source.
struct SliceName {
  std::uint32_t scan_id = 0;
  std::uint32_t index = 0;
  std::uint32_t count = 1;
};

/// Slices stand alone if no receiver, or more than one, acknowledges them. Times of calls never go
/// back. For one thread at a time.
class ReferenceKeeper {
 public:
  /// Longest time between slices that stand alone, for late receivers; 0: no limit.
  void set_key_interval(Duration interval) { key_interval_ = interval; }

  /// Notes that `receiver` has all of the slice.
  void OnAcknowledged(Time now, std::uint32_t receiver, std::uint32_t scan_id, std::uint32_t index);
  /// Lets the next slices stand alone.
  void OnKeyRequest();

  /// Begins the next slice. Returns false if it cannot become a reference.
  bool Begin(Time now, const SliceName& slice);
  /// Returns true if the receiver has an earlier slice of the sector.
  bool HasReference() const { return current_ != nullptr && !current_->reference.empty(); }
  /// Blocks of the earlier slice.
  std::vector<BlockMemoryPtr> references() const {
    return HasReference() ? current_->reference : std::vector<BlockMemoryPtr>{};
  }
  /// Returns the earlier slice's block with the columns of `image`, or null.
  BlockMemoryPtr Reference(const RangeImage& image) const;
  /// Takes the memories of the blocks of the slice that Begin() began. Call it once at most.
  void OnEncoded(std::vector<BlockMemoryPtr> blocks);

  /// Bytes of all memories.
  std::size_t bytes() const { return bytes_; }

  /// Lower than the limits of BlockStore, because slices may be reordered.
  static constexpr std::size_t kMostOfSlice = 20;
  static constexpr std::size_t kMostBytes = 48U << 20;
  /// Silence after which a receiver is assumed to be gone.
  static constexpr Duration kPatience = std::chrono::seconds(2);

 private:
  struct Sent {
    std::uint32_t scan_id = 0;
    std::vector<BlockMemoryPtr> blocks;
  };
  /// A sector, over all scans.
  struct Slot {
    std::deque<Sent> sent;                  // slices since the reference, the oldest first
    std::vector<BlockMemoryPtr> reference;  // empty: none
    std::optional<Time> begun;              // the newest slice
  };
  void Forget();
  void Release(const std::vector<BlockMemoryPtr>& blocks);
  void Restart(Slot* slot);

  Duration key_interval_ = std::chrono::seconds(10);
  std::map<std::uint32_t, Slot> slots_;
  Slot* current_ = nullptr;
  SliceName name_;
  std::size_t bytes_ = 0;

  std::optional<std::uint32_t> receiver_;
  Time last_heard_{};
  Time alone_since_{};  // from then on there is only one receiver
};

}  // namespace lidar::codec
