// SPDX-License-Identifier: LGPL-2.1-or-later
// Guesses the numbers in the exact fields of points, such as their times. Points of a firing have
// similar numbers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

#include "src/codec/cloud/exact_number.h"

namespace lidar::codec::cloud {

/// Guesses a level as the sum of two numbers: the base of the firing and the offset of the beam.
/// Both are learnt from the levels so far.
class FiringGuess {
 public:
  explicit FiringGuess(std::uint32_t beams) : beams_(beams) {}

  std::int64_t LevelOf(std::uint32_t beam, std::uint32_t firing) {
    starts_ = !begun_ || firing != firing_;
    base_ = base_now_;
    if (begun_ && firing > firing_ && firing_ > first_firing_) {
      const std::int64_t run = Minus(base_now_, first_base_);
      const std::int64_t slope = run / static_cast<std::int64_t>(firing_ - first_firing_);
      base_ = Plus(base_now_, Times(slope, firing - firing_));
    }
    return Plus(base_, beams_[beam].offset);
  }
  /// Updates base and offset by the true level of the point for which LevelOf() was called last.
  void Learn(std::uint32_t beam, std::uint32_t firing, std::int64_t level) {
    Beam& b = beams_[beam];
    const std::int64_t off = Minus(level, Plus(base_, b.offset));
    count_ = starts_ ? 1 : count_ + 1;
    if (!begun_ || (starts_ && b.is_known)) {
      base_ = Plus(base_, off);
    } else if (b.is_known && std::abs(off / 2) < kNear / 2) {
      // Rounded levels are on both sides of the guess, so a small difference changes offset and
      // base only in part.
      b.offset = Plus(b.offset, off / 8);
      base_ = Plus(base_, off / (count_ + 1));
    } else {
      b.offset = Plus(b.offset, off);
    }
    b.is_known = true;
    if (!begun_) {
      first_base_ = base_;
      first_firing_ = firing;
    }
    begun_ = true;
    base_now_ = base_;
    firing_ = firing;
  }
  bool starts() const { return starts_; }
  bool Knows(std::uint32_t beam) const { return beams_[beam].is_known; }

 private:
  static constexpr std::int64_t kNear = 8 * NumberForm::kParts;
  struct Beam {
    std::int64_t offset = 0;
    bool is_known = false;
  };
  std::vector<Beam> beams_;
  std::int64_t base_ = 0;      // base in the last guess
  std::int64_t base_now_ = 0;  // base of the last point's firing
  std::int64_t first_base_ = 0;
  std::uint32_t firing_ = 0;
  std::uint32_t first_firing_ = 0;
  std::int64_t count_ = 0;  // points of the firing so far
  bool begun_ = false;
  bool starts_ = true;  // the point is the first of its firing
};

/// Keeps the last level of each beam in each firing of a period, as a guess for the next period. If
/// the period is 0, keeps nothing.
class RepeatGuess {
 public:
  RepeatGuess(std::uint32_t beams, std::uint32_t period)
      : period_(period), levels_(std::size_t{beams} * period) {}

  /// Returns where the level is stored. It is empty at first. Returns null if the period is 0.
  std::optional<std::int64_t>* At(std::uint32_t beam, std::uint32_t firing) {
    if (levels_.empty()) return nullptr;
    return &levels_[std::size_t{beam} * period_ + firing % period_];
  }

 private:
  std::uint32_t period_;
  std::vector<std::optional<std::int64_t>> levels_;
};

}  // namespace lidar::codec::cloud
