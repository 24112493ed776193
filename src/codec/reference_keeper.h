// SPDX-License-Identifier: LGPL-2.1-or-later
// Which slices an encoder may refer to: the newest that its receiver has said it has.
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

/// A slice by its source's numbers.
struct SliceName {
  std::uint32_t scan_id = 0;
  std::uint32_t index = 0;
  std::uint32_t count = 1;
};

/// There is nothing to refer to without acknowledgements, or with those of several receivers.
/// All calls name the time; it never goes back. For one thread at a time.
class ReferenceKeeper {
 public:
  /// Slices that stand alone come at least so often, for those who join late; 0: never again.
  void set_key_interval(Duration interval) { key_interval_ = interval; }

  /// `receiver` has all of the slice.
  void OnAcknowledged(Time now, std::uint32_t receiver, std::uint32_t scan_id, std::uint32_t index);
  /// Somebody needs slices that stand alone, now.
  void OnKeyRequest();

  /// The next slice; false where none can be remembered.
  bool Begin(Time now, const SliceName& slice);
  /// The receiver has an earlier slice of that sector.
  bool HasReference() const { return current_ != nullptr && !current_->reference.empty(); }
  /// The blocks of that one.
  std::vector<BlockMemoryPtr> references() const {
    return HasReference() ? current_->reference : std::vector<BlockMemoryPtr>{};
  }
  /// A block of that slice that the receiver has, at the place of `image`; null: none.
  BlockMemoryPtr Reference(const RangeImage& image) const;
  /// What the blocks of that slice left, at most once.
  void OnEncoded(std::vector<BlockMemoryPtr> blocks);

  /// Bytes of all that is remembered.
  std::size_t bytes() const { return bytes_; }

  /// Lower than those of BlockStore, for slices that came in another order.
  static constexpr std::size_t kMostOfSlice = 20;
  static constexpr std::size_t kMostBytes = 48U << 20;
  /// A receiver that acknowledges nothing for so long is gone.
  static constexpr Duration kPatience = std::chrono::seconds(2);

 private:
  struct Sent {
    std::uint32_t scan_id = 0;
    std::vector<BlockMemoryPtr> blocks;
  };
  /// A sector of all scans.
  struct Slot {
    std::deque<Sent> sent;                  // since the reference, the oldest first
    std::vector<BlockMemoryPtr> reference;  // empty: none
    std::optional<Time> last_key;
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
  Time alone_since_{};  // the receiver has been the only one
};

}  // namespace lidar::codec
