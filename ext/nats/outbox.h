// SPDX-License-Identifier: LGPL-2.1-or-later
// What waits to be sent, and what was sent and waits for its acknowledgement, in bounded memory.
#pragma once
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

#include "ext/nats/stream_format.h"
#include "gst/common/refs.h"

namespace lidar::nats {

struct Outgoing {
  std::uint64_t number = 0;
  gst::BufferPtr buffer;
  StreamFormat::Ptr format;
};

/// Used under the lock of its owner.
class Outbox {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Outbox(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Drops the oldest that wait where it is full: how many.
  std::size_t Push(Outgoing item);

  /// The oldest that waits. It is in flight from now on, until Remove() or Retry().
  std::optional<Outgoing> Take(Clock::time_point now);
  /// False where `number` is not in flight.
  bool Remove(std::uint64_t number);
  /// What is in flight waits again, and goes first: how many.
  std::size_t Retry(std::uint64_t number);
  std::size_t RetryAll();
  /// Forgets all: how many.
  std::size_t Clear();

  /// The format of the oldest message that waits; null: none does.
  StreamFormat::Ptr NextFormat() const;
  /// Since when the oldest is in flight.
  std::optional<Clock::time_point> OldestInFlight() const;

  std::size_t waiting() const { return waiting_.size(); }
  std::size_t in_flight() const { return in_flight_.size(); }
  std::size_t bytes() const { return bytes_; }
  bool empty() const { return waiting_.empty() && in_flight_.empty(); }

 private:
  struct Sent {
    Outgoing item;
    Clock::time_point at;
  };
  static std::size_t SizeOf(const Outgoing& item);
  void Count(const Outgoing& item);
  void Uncount(const Outgoing& item);

  const std::size_t max_bytes_;
  std::map<std::uint64_t, Outgoing> waiting_;
  std::map<std::uint64_t, Sent> in_flight_;
  std::map<StreamFormat::Ptr, std::size_t> formats_;  // messages of each in both
  std::size_t bytes_ = 0;                             // of all three
};

}  // namespace lidar::nats
