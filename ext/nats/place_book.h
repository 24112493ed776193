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
    bool again = false;         // the same message has come before
    bool late = false;          // a later message has come before
    bool fills_gap = false;     // an earlier `missing` counted it
    std::uint64_t missing = 0;  // numbers between it and the newest earlier one
  };
  /// Notes a message. Memory is bounded, so a very old one may seem new.
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
