// SPDX-License-Identifier: LGPL-2.1-or-later
// The message of a stream from which a decoder has to start.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "src/base/time.h"

namespace lidar::worker {

/// The messages of the last while. Deterministic; for one thread.
class RewindWindow {
 public:
  struct Message {
    std::uint64_t number = 0;
    std::uint64_t stored_ns = 0;  // by JetStream
    std::optional<std::uint64_t> captured_ns;
  };

  explicit RewindWindow(Duration rewind) : rewind_ns_(static_cast<std::uint64_t>(rewind.count())) {}

  /// The window begins anew if the number goes back.
  void Add(const Message& message);
  /// Number of the first; there has to be one.
  std::uint64_t first() const { return messages_.front().number; }

 private:
  bool IsOld(const Message& message) const;

  const std::uint64_t rewind_ns_;
  std::deque<Message> messages_;
};

}  // namespace lidar::worker
