// SPDX-License-Identifier: LGPL-2.1-or-later
// Which messages of a stream came, so that none is taken twice.
#pragma once
#include <cstdint>
#include <deque>
#include <map>

#include "ext/nats/message.h"

namespace lidar::nats {

class PlaceBook {
 public:
  struct Verdict {
    bool again = false;         // it came before
    bool late = false;          // one behind it came before
    bool fills_gap = false;     // it was counted in `missing`
    std::uint64_t missing = 0;  // numbers between it and the newest before it
  };
  /// Notes it. Memory is bounded, so one that is very old may seem new.
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
