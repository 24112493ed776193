// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages that wait to be sent or for their acknowledgement, in bounded memory.
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

/// The owner's lock guards it.
class Outbox {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Outbox(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Adds a message. If there is no room, drops the oldest waiting messages; returns how many.
  std::size_t Push(Outgoing item);

  /// Takes the oldest waiting message, which is in flight until Remove() or Retry().
  std::optional<Outgoing> Take(Clock::time_point now);
  /// Returns false if `number` is not in flight.
  bool Remove(std::uint64_t number);
  /// Makes messages in flight wait again, before all others. Returns how many.
  std::size_t Retry(std::uint64_t number);
  std::size_t RetryAll();
  /// Forgets all messages; returns how many.
  std::size_t Clear();

  /// The format of the oldest message that waits, or null.
  StreamFormat::Ptr NextFormat() const;
  /// Returns the time of the oldest Take() of a message in flight.
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
  std::map<StreamFormat::Ptr, std::size_t> formats_;  // number of messages by format
  std::size_t bytes_ = 0;                             // of messages and formats
};

}  // namespace lidar::nats
