// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages that wait to be sent or to be acknowledged, in bounded memory.
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

/// A queue of messages in bounded memory. It is not thread-safe, so its owner needs a lock.
class Outbox {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Outbox(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Adds a message. If the memory is exceeded, drops the oldest waiting messages. Returns the
  /// number of dropped messages.
  std::size_t Push(Outgoing item);

  /// Returns the oldest waiting message. The message is in flight until Remove() or Retry() gets
  /// its number.
  std::optional<Outgoing> Take(Clock::time_point now);
  /// Removes the message `number`. Returns false if it is not in flight.
  bool Remove(std::uint64_t number);
  /// Make the message `number`, or all messages in flight, wait again, before all newer messages.
  /// Return the number of messages.
  std::size_t Retry(std::uint64_t number);
  std::size_t RetryAll();
  /// Removes all messages. Returns their number.
  std::size_t Clear();

  /// Returns the format of the oldest waiting message, or null if no message waits.
  StreamFormat::Ptr NextFormat() const;
  /// Returns the time at which Take() returned the message that is in flight the longest.
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
  std::map<StreamFormat::Ptr, std::size_t> formats_;  // number of messages of each format
  std::size_t bytes_ = 0;                             // of messages and formats
};

}  // namespace lidar::nats
