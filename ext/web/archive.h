// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads what a recording holds of a stream: its slices, and poses of their sensor.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ext/web/topic.h"

namespace lidar::web {

/// For one thread at a time. Times are close to capture times [ns].
class Archive {
 public:
  struct Times {
    std::uint64_t from_ns = 0;
    std::uint64_t to_ns = 0;
  };
  struct Item {
    std::uint64_t time_ns = 0;
    std::uint64_t position = 0;           // where reading continues after it
    std::size_t read = 0;                 // bytes that were read for it
    std::shared_ptr<SliceMessage> slice;  // null: of another stream, or damaged
    bool is_damaged = false;
    bool may_end_piece = true;  // false: the position would leave out later items
  };

  virtual ~Archive() = default;
  /// Returns the first and last time that can be read now. Returns nothing if nothing can be read,
  /// and sets `why` for a user.
  virtual std::optional<Times> Look(std::string* why) = 0;
  /// Continues at a time, or after the item that had the `position`.
  virtual void Seek(std::uint64_t time_ns) = 0;
  virtual void GoOn(std::uint64_t position) = 0;
  /// Returns nothing if there is no next item yet, or soon after Cancel().
  virtual std::optional<Item> Next() = 0;
  /// Closes files and frees buffers until the next Seek() or GoOn().
  virtual void Rest() = 0;
  /// Number of parts that were left out, damaged items not counted.
  virtual std::uint64_t damaged() const = 0;

  /// Any thread may call it.
  void Cancel() { cancelled_ = true; }

 protected:
  std::atomic<bool> cancelled_{false};
};

}  // namespace lidar::web
