// SPDX-License-Identifier: LGPL-2.1-or-later
// Chooses the effort of the coder by the time that the coding of slices takes.
#pragma once
#include <array>
#include <cstddef>

#include "src/base/time.h"

namespace lidar::codec {

/// Chooses the highest effort at which the coding of a slice takes no more than kAllowedPart of its
/// sweep time. The clock of this class is the sum of the sweep times.
class EffortControl {
 public:
  static constexpr unsigned kHighest = 3;
  /// The part of a slice's sweep time that its coding may take.
  static constexpr double kAllowedPart = 0.25;

  /// Returns the effort for the next slice.
  unsigned effort() const { return effort_; }
  /// Notes that a slice was coded at effort(). It has `returns`, its sweep took `sweep`, and its
  /// coding took `spent`.
  void OnSlice(Duration sweep, std::size_t returns, Duration spent);

 private:
  /// A window of about a second. At its end the effort may change.
  struct Window {
    Duration swept{};
    unsigned slices = 0;
    unsigned late = 0;  // slices that took more than the allowed time
    double spent_s = 0;
    double returns = 0;
    double most_returns_per_s = 0;  // of a slice, per second of its sweep time
  };
  struct Level {
    double ratio;           // cost relative to the next lower level
    Duration hold{};        // pause after the level was last too slow
    Duration not_before{};  // the level is not tried before this time
  };
  void Reconsider(double cost);
  void LearnRatio(double cost);
  void Lower();

  unsigned effort_ = 1;
  Duration now_{};
  unsigned much_too_late_ = 0;  // consecutive slices that took more than twice their time
  Window window_;
  double cost_below_ = 0;  // cost before the last raise [s per return]; 0: no recent raise
  std::array<Level, kHighest + 1> levels_ = {{{1}, {5}, {1.7}, {2.7}}};
};

}  // namespace lidar::codec
