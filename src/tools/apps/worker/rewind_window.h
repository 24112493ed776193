// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the message of a stream from which a decoder must start.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "src/base/time.h"

namespace lidar::worker {

/// Recent messages. Deterministic; for one thread.
class RewindWindow {
 public:
  struct Message {
    std::uint64_t number = 0;
    std::uint64_t stored_ns = 0;  // by JetStream
    std::optional<std::uint64_t> captured_ns;
  };

  explicit RewindWindow(Duration rewind) : rewind_ns_(static_cast<std::uint64_t>(rewind.count())) {}

  /// Adds a message. A lower number restarts the window.
  void Add(const Message& message);
  /// Number of the oldest message; the window must not be empty.
  std::uint64_t first() const { return messages_.front().number; }

 private:
  bool IsOld(const Message& message) const;

  const std::uint64_t rewind_ns_;
  std::deque<Message> messages_;
};

}  // namespace lidar::worker
