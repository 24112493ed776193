// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the message of a stream at which a decoder must start.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "src/base/time.h"

namespace lidar::worker {

/// The recent messages of a stream. Deterministic. Only one thread may use it.
class RewindWindow {
 public:
  struct Message {
    std::uint64_t number = 0;
    std::uint64_t stored_ns = 0;  // time at which JetStream stored the message
    std::optional<std::uint64_t> captured_ns;
  };

  explicit RewindWindow(Duration rewind) : rewind_ns_(static_cast<std::uint64_t>(rewind.count())) {}

  /// Adds a message. If its number is not higher than that of the last message, removes all earlier
  /// messages first.
  void Add(const Message& message);
  /// Returns the number of the oldest message. The window must not be empty.
  std::uint64_t first() const { return messages_.front().number; }

 private:
  bool IsOld(const Message& message) const;

  const std::uint64_t rewind_ns_;
  std::deque<Message> messages_;
};

}  // namespace lidar::worker
