// SPDX-License-Identifier: LGPL-2.1-or-later
// Keeps the slices to which an encoder may refer. In each sector, this is the newest slice that the
// receiver has acknowledged.
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

/// The numbers that identify a slice at its source.
struct SliceName {
  std::uint32_t scan_id = 0;
  std::uint32_t index = 0;
  std::uint32_t count = 1;
};

/// There are references only if exactly one receiver acknowledges slices. Otherwise each slice is
/// coded without a reference. The time must not decrease from call to call. Not thread-safe.
class ReferenceKeeper {
 public:
  /// Sets the longest time between two slices of a sector that have no reference. Receivers that
  /// start later can decode these slices. 0: no limit.
  void set_key_interval(Duration interval) { key_interval_ = interval; }

  /// Notes that `receiver` has received the whole slice.
  void OnAcknowledged(Time now, std::uint32_t receiver, std::uint32_t scan_id, std::uint32_t index);
  /// Has the next slices of each sector coded without a reference.
  void OnKeyRequest();

  /// Begins the next slice. Returns false if later slices cannot refer to it.
  bool Begin(Time now, const SliceName& slice);
  /// Returns true if the receiver has an earlier slice of the same sector, to which the slice may
  /// refer.
  bool HasReference() const { return current_ != nullptr && !current_->reference.empty(); }
  /// Returns the blocks of the earlier slice.
  std::vector<BlockMemoryPtr> references() const {
    return HasReference() ? current_->reference : std::vector<BlockMemoryPtr>{};
  }
  /// Returns the block of the earlier slice that has the same beams and columns as `image`, or
  /// null.
  BlockMemoryPtr Reference(const RangeImage& image) const;
  /// Keeps the memories of the blocks in the slice that Begin() began. Must be called at most once
  /// for a slice.
  void OnEncoded(std::vector<BlockMemoryPtr> blocks);

  /// Returns the size of all memories.
  std::size_t bytes() const { return bytes_; }

  /// These limits are lower than those of BlockStore. Slices may arrive in another order, but the
  /// receiver must still have the blocks to which they refer.
  static constexpr std::size_t kMostOfSlice = 20;
  static constexpr std::size_t kMostBytes = 48U << 20;
  /// The time without acknowledgements after which a receiver is assumed to be gone.
  static constexpr Duration kPatience = std::chrono::seconds(2);

 private:
  struct Sent {
    std::uint32_t scan_id = 0;
    std::vector<BlockMemoryPtr> blocks;
  };
  /// A sector: the slices that have the same index in their scans.
  struct Slot {
    std::deque<Sent> sent;                  // slices after the reference, the oldest first
    std::vector<BlockMemoryPtr> reference;  // empty: none
    std::optional<Time> begun;              // when the newest slice was begun
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
  Time alone_since_{};  // before this time there may be two receivers
};

}  // namespace lidar::codec
