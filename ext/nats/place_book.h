// SPDX-License-Identifier: LGPL-2.1-or-later
// Records which messages of a stream arrived, so that each is used once.
#pragma once
#include <cstdint>
#include <deque>
#include <map>

#include "ext/nats/message.h"

namespace lidar::nats {

class PlaceBook {
 public:
  struct Verdict {
    bool again = false;         // this message has arrived before
    bool late = false;          // a later message has arrived before
    bool fills_gap = false;     // an earlier call counted this message as missing
    std::uint64_t missing = 0;  // messages between the newest earlier message and this one
  };
  /// Notes a message. Memory is bounded, so a repeated message may seem new if it is very old.
  Verdict Note(const Place& place);

 private:
  using Spans = std::map<std::uint64_t, std::uint64_t>;  // first and last number, without gaps
  struct Run {
    std::uint64_t run = 0;
    Spans spans;
  };
  Spans& SpansOf(std::uint64_t run);

  std::deque<Run> runs_;  // the newest last
};

}  // namespace lidar::nats
