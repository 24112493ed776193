// SPDX-License-Identifier: LGPL-2.1-or-later
// Chooses between the bins that returns may take by what they cost to code.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/codec/mixing/cost_meter.h"
#include "src/codec/mixing/range_part.h"

namespace lidar::codec::mixing {

/// A beam search along each row, with the models of the coder as they are before it. A bin that is
/// cheap by itself may make the next ones expensive, so a few ways are followed at a time.
template <class Effort>
class BinSearch {
 public:
  BinSearch(const Kernel& kernel, Model* model, std::int64_t step_mm)
      : part_(kernel, model, &meter_, step_mm) {}

  /// A row of returns, as RangePart takes it.
  struct Row {
    const Azimuth* above;
    const std::int32_t* north;
    const std::uint8_t* spare;  // how many bins more than one each return may take
    std::uint32_t columns;
  };
  /// False where the returns so far were so rough that there is next to nothing to choose.
  bool IsWorthwhile() const {
    constexpr std::int64_t kMostCost = 461;  // 2.6 bits
    return cost_ <= kMostCost * tried_;
  }

  /// `bins` are the first that returns may take, and become those that they do take.
  void Choose(const Row& row, std::int32_t* bins) {
    part_.StartRow(row.above, row.north);
    steps_.clear();
    ways_[0] = {part_.row(), 0, 0};
    count_ = 1;
    for (std::uint32_t i = 0; i < row.columns; ++i) {
      if (bins[i] < 0) {
        Skip(i);
      } else {
        Try(i, row, bins[i]);
        KeepBest();
      }
    }
    cost_ += ways_[0].cost;
    part_.Resume(ways_[0].state);
    TraceBack(row.columns, bins);
  }

 private:
  using Part = RangePart<Effort, CostMeter>;
  static constexpr std::size_t kMostWays = 2;  // more save 0.2 %
  struct Way {
    typename Part::Row state;
    std::int64_t cost;
    std::size_t steps;  // index in steps_ + 1
  };
  struct Step {
    std::int32_t bin;
    std::size_t before;
  };
  struct Trial {
    Way way;  // its steps are those before
    std::int32_t bin;
  };

  void Skip(std::uint32_t i) {
    for (std::size_t k = 0; k < count_; ++k) {
      part_.Resume(ways_[k].state);
      part_.Skip(i);
      ways_[k].state = part_.row();
    }
  }

  void Try(std::uint32_t i, const Row& row, std::int32_t first) {
    trials_.clear();
    const bool is_free = row.spare[i] > 0 || count_ > 1;
    tried_ += is_free ? 1 : 0;
    for (std::size_t k = 0; k < count_; ++k) {
      part_.Resume(ways_[k].state);
      part_.Consider(i);
      for (std::int32_t bin = first; bin <= first + row.spare[i]; ++bin) {
        Trial trial{ways_[k], bin};
        if (is_free) trial.way.cost += part_.CostOf(bin, &meter_);
        Azimuth azimuth = row.above[i];
        part_.Resume(ways_[k].state);
        part_.See(bin, &azimuth);
        trial.way.state = part_.row();
        Insert(trial);
      }
    }
  }

  /// Behind those that are as cheap.
  void Insert(const Trial& trial) {
    const auto place = std::find_if(trials_.begin(), trials_.end(), [&](const Trial& other) {
      return other.way.cost > trial.way.cost;
    });
    trials_.insert(place, trial);
  }

  /// Keeps the cheapest trials, and one of two that end alike.
  void KeepBest() {
    count_ = 0;
    for (const Trial& trial : trials_) {
      const auto ends_alike = [&](const Way& way) {
        return way.state.west[0] == trial.way.state.west[0] &&
               way.state.west[1] == trial.way.state.west[1];
      };
      if (std::any_of(ways_.begin(), ways_.begin() + count_, ends_alike)) continue;
      steps_.push_back({trial.bin, trial.way.steps});
      ways_[count_] = trial.way;
      ways_[count_].steps = steps_.size();
      if (++count_ == kMostWays) break;
    }
  }

  void TraceBack(std::uint32_t columns, std::int32_t* bins) const {
    std::size_t step = ways_[0].steps;
    for (std::uint32_t i = columns; i-- > 0;) {
      if (bins[i] < 0) continue;
      bins[i] = steps_[step - 1].bin;
      step = steps_[step - 1].before;
    }
  }

  CostMeter meter_;
  Part part_;
  std::array<Way, kMostWays> ways_{};  // the cheapest first
  std::size_t count_ = 0;
  std::vector<Step> steps_;
  std::vector<Trial> trials_;  // the cheapest first
  std::int64_t cost_ = 0;      // of the rows so far
  std::int64_t tried_ = 0;     // returns of which it is the cost
};

}  // namespace lidar::codec::mixing
