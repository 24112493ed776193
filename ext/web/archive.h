// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads a stream from a recording: its slices, and the poses of its sensor.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ext/web/topic.h"

namespace lidar::web {

/// A recording of a stream. Only one thread at a time may use it. Times are close to capture times
/// [ns].
class Archive {
 public:
  struct Times {
    std::uint64_t from_ns = 0;
    std::uint64_t to_ns = 0;
  };
  struct Item {
    std::uint64_t time_ns = 0;
    std::uint64_t position = 0;           // where reading continues after this item
    std::size_t read = 0;                 // number of bytes that were read to get this item
    std::shared_ptr<SliceMessage> slice;  // null if the item is damaged or of another stream
    bool is_damaged = false;
    bool may_end_piece = true;  // false: continuing at `position` would skip later items
  };

  virtual ~Archive() = default;
  /// Returns the first and the last time that can be read now. If nothing can be read, returns
  /// nothing and sets `why` to a text for users.
  virtual std::optional<Times> Look(std::string* why) = 0;
  /// Set where Next() continues: at a time, or after the item that has `position`.
  virtual void Seek(std::uint64_t time_ns) = 0;
  virtual void GoOn(std::uint64_t position) = 0;
  /// Returns the next item, or nothing if there is none yet. Also returns nothing soon after
  /// Cancel().
  virtual std::optional<Item> Next() = 0;
  /// Returns a text for users if the last Next() returned nothing because of an error, or an empty
  /// text.
  virtual std::string error() const { return ""; }
  /// Closes files and frees buffers. Seek() or GoOn() opens them again.
  virtual void Rest() = 0;
  /// Returns the number of parts that were skipped. Damaged items are not counted.
  virtual std::uint64_t damaged() const = 0;

  /// Makes a running Next() return soon. Any thread may call this function.
  void Cancel() { cancelled_ = true; }

 protected:
  std::atomic<bool> cancelled_{false};
};

}  // namespace lidar::web
