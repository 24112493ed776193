// SPDX-License-Identifier: LGPL-2.1-or-later
// Chooses how hard the coder may try, from the time that its slices take.
#pragma once
#include <array>
#include <cstddef>

#include "src/base/time.h"

namespace lidar::codec {

/// Takes the highest effort whose slices are coded in a part of the time in which they were swept.
/// It knows no clock: its time is the sum of the sweeps.
class EffortControl {
 public:
  static constexpr unsigned kHighest = 3;
  /// Part of its sweep that a slice may take.
  static constexpr double kAllowedPart = 0.25;

  /// For the next slice.
  unsigned effort() const { return effort_; }
  /// The slice with `returns`, swept in `sweep`, took `spent` to code at effort().
  void OnSlice(Duration sweep, std::size_t returns, Duration spent);

 private:
  /// Slices of about a second, after which the effort is thought over.
  struct Window {
    Duration swept{};
    unsigned slices = 0;
    unsigned late = 0;  // took more than they may
    double spent_s = 0;
    double returns = 0;
    double most_returns_per_s = 0;  // of sweep
  };
  struct Level {
    double ratio;           // what it costs against the level below
    Duration hold{};        // how long it is left alone after it proved too slow
    Duration not_before{};  // when it may be tried again
  };
  void Reconsider(double cost);
  void LearnRatio(double cost);
  void Lower();

  unsigned effort_ = 1;
  Duration now_{};
  unsigned much_too_late_ = 0;  // slices one after the other
  Window window_;
  double cost_below_ = 0;  // s a return, just before the effort was raised; 0: it was not
  std::array<Level, kHighest + 1> levels_ = {{{1}, {5}, {1.7}, {2.7}}};
};

}  // namespace lidar::codec
