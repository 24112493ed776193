// SPDX-License-Identifier: LGPL-2.1-or-later
// Counts the messages that a source received and missed.
#pragma once
#include <cstddef>
#include <cstdint>
#include <mutex>

#include "ext/nats/place_book.h"
#include "ext/nats/subscriber.h"

namespace lidar::nats {

struct SourceCounters {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::uint64_t damaged = 0;
  std::uint64_t without_caps = 0;
  std::uint64_t not_accepted = 0;
  std::uint64_t lost = 0;
  std::uint64_t again = 0;
  std::uint64_t late = 0;
  std::uint64_t overruns = 0;
  std::uint64_t damaged_formats = 0;
  unsigned reconnects = 0;
  bool connected = false;
};

/// Counters of a source. Only one thread may change them. Any thread may call counters().
class SourceAccount {
 public:
  SourceCounters counters() const;

  void Reset();
  void Count(std::uint64_t SourceCounters::*counter);
  void NoteTaken(std::size_t bytes);
  void NoteSubscriber(const Subscriber& subscriber);
  void NoteStop();

  struct Verdict {
    bool again = false;  // sent again, because JetStream got no acknowledgement
    bool gap = false;    // messages before it are missing
  };
  /// Notes the position of a message. If `shared` is set, a queue group shares the stream. Messages
  /// that are missing here went to other members of the group and are not lost.
  Verdict NotePlace(const Place& place, bool shared);

 private:
  PlaceBook places_;
  mutable std::mutex mutex_;  // guards counters_
  SourceCounters counters_;
};

}  // namespace lidar::nats
