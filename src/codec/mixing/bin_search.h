// SPDX-License-Identifier: LGPL-2.1-or-later
// For each return, chooses the bin that is cheapest to code from the bins that the return may have.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "src/codec/mixing/cost_meter.h"
#include "src/codec/mixing/range_part.h"

namespace lidar::codec::mixing {

/// A beam search along a row of pixels. The search finds out the costs of bins with the models as
/// they are before the row. Since a cheap bin may make the following bins expensive, the search
/// keeps the two cheapest sequences of bins, which are called ways.
template <class Effort>
class BinSearch {
 public:
  /// `steps` is a buffer for the search. The caller keeps it, so that later searches need no new
  /// one.
  BinSearch(Model* model, std::int64_t step_mm, std::vector<SearchStep>* steps)
      : parts_{{{model, &meter_, step_mm}, {model, &meter_, step_mm}}}, steps_(*steps) {}

  /// A row of pixels. `above` and `north` are the arguments of RangePart::StartRow().
  struct Row {
    const Azimuth* above;
    const std::int32_t* north;
    const std::uint8_t* spare;  // for each return, the number of further bins that it may have
    std::uint32_t columns;
  };

  /// Replaces the bins of a row by those of the cheapest way. On entry, `bins` has the first bin
  /// that each return may have, and kNoReturn for the other pixels.
  void Choose(const Row& row, std::int32_t* bins) {
    for (Part& part : parts_) part.StartRow(row.above, row.north);
    steps_.clear();
    ways_[0] = {};
    count_ = 1;
    for (std::uint32_t i = 0; i < row.columns; ++i) {
      if (bins[i] < 0) {
        for (unsigned k = 0; k < count_; ++k) parts_[k].Skip(i);
      } else {
        Try(i, bins[i], bins[i] + row.spare[i]);
        Go(row.above[i]);
      }
    }
    TraceBack(row.columns, bins);
  }

 private:
  using Part = RangePart<Effort, CostMeter>;
  static constexpr unsigned kMostWays = 2;  // more ways would save only 0.2 %
  /// A way is dropped if it costs this much more than the cheapest way. A way this far behind
  /// hardly ever becomes the cheapest one.
  static constexpr std::int64_t kMostBehind = 1'065;  // 6 bits
  struct Way {
    std::int64_t cost = 0;
    std::uint32_t steps = 0;  // 1 + index of the newest step in steps_; 0: none
  };
  struct Trial {
    std::int64_t cost;
    std::int32_t bin;
    unsigned way;
  };

  void Try(std::uint32_t i, std::int32_t first, std::int32_t last) {
    found_ = 0;
    for (unsigned k = 0; k < count_; ++k) {
      if (IsHopeless(ways_[k].cost)) continue;
      Part& part = parts_[k];
      part.Consider(i);
      if (count_ == 1 && first == last) {
        Offer({ways_[k].cost, first, k});
        continue;
      }
      const auto try_bin = [&](std::int32_t bin) {
        const std::int64_t most = found_ > 0 ? trials_[0].cost + kMostBehind : INT64_MAX;
        Offer({ways_[k].cost + part.CostOf(bin, most - ways_[k].cost), bin, k});
      };
      // Begins with the bin that is probably the cheapest. CostOf() of a dearer bin then returns
      // early, once the cost exceeds `most`.
      const std::int32_t likely = std::clamp(part.Predicted(), first, last);
      try_bin(likely);
      for (std::int32_t bin = first; bin <= last; ++bin)
        if (bin != likely) try_bin(bin);
    }
  }
  bool IsHopeless(std::int64_t cost) const {
    return found_ > 0 && cost > trials_[0].cost + kMostBehind;
  }

  /// Keeps `trial` if it is one of the two cheapest. If the last two bins of two trials are equal,
  /// only the cheaper of these trials is kept.
  void Offer(const Trial& trial) {
    if (IsHopeless(trial.cost)) return;
    if (found_ == 0) {
      trials_[0] = trial;
      found_ = 1;
    } else if (trial.cost < trials_[0].cost) {
      if (!EndAlike(trial, trials_[0])) {
        trials_[1] = trials_[0];
        found_ = 2;
      }
      trials_[0] = trial;
      if (found_ == 2 && IsHopeless(trials_[1].cost)) found_ = 1;
    } else if (!EndAlike(trial, trials_[0]) && (found_ == 1 || trial.cost < trials_[1].cost)) {
      trials_[1] = trial;
      found_ = 2;
    }
  }
  bool EndAlike(const Trial& a, const Trial& b) const {
    return a.bin == b.bin && parts_[a.way].row().west[0] == parts_[b.way].row().west[0];
  }

  /// Makes each kept trial a way, which is one step longer than the way that the trial extends.
  void Go(const Azimuth& above) {
    const std::array<typename Part::Row, kMostWays> before = {parts_[0].row(), parts_[1].row()};
    std::array<typename Part::Row, kMostWays> after;
    std::array<Way, kMostWays> ways;
    for (unsigned k = 0; k < found_; ++k) {
      const Trial& trial = trials_[k];
      Part& part = parts_[trial.way];
      Azimuth azimuth = above;
      part.Resume(before[trial.way]);
      part.See(trial.bin, &azimuth);
      after[k] = part.row();
      steps_.push_back({trial.bin, ways_[trial.way].steps});
      ways[k] = {trial.cost, static_cast<std::uint32_t>(steps_.size())};
    }
    count_ = found_;
    for (unsigned k = 0; k < count_; ++k) {
      parts_[k].Resume(after[k]);
      ways_[k] = ways[k];
    }
  }

  void TraceBack(std::uint32_t columns, std::int32_t* bins) const {
    std::uint32_t step = ways_[0].steps;
    for (std::uint32_t i = columns; i-- > 0;) {
      if (bins[i] < 0) continue;
      bins[i] = steps_[step - 1].bin;
      step = steps_[step - 1].before;
    }
  }

  CostMeter meter_;
  std::array<Part, kMostWays> parts_;  // part k has the state at the end of way k
  std::array<Way, kMostWays> ways_{};  // the cheapest first
  unsigned count_ = 0;
  std::array<Trial, kMostWays> trials_{};  // for the current return, the cheapest first
  unsigned found_ = 0;
  std::vector<SearchStep>& steps_;
};

}  // namespace lidar::codec::mixing
