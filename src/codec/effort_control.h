// SPDX-License-Identifier: LGPL-2.1-or-later
// Chooses the coder's effort from the time that its slices take.
#pragma once
#include <array>
#include <cstddef>

#include "src/base/time.h"

namespace lidar::codec {

/// Chooses the highest effort that codes slices in kAllowedPart of their sweep time. Sweep times,
/// added up, are its clock.
class EffortControl {
 public:
  static constexpr unsigned kHighest = 3;
  /// Part of a slice's sweep time that its coding may take.
  static constexpr double kAllowedPart = 0.25;

  /// Effort of the next slice.
  unsigned effort() const { return effort_; }
  /// Notes that a slice with `returns`, swept in `sweep`, was coded at effort() in `spent`.
  void OnSlice(Duration sweep, std::size_t returns, Duration spent);

 private:
  /// Slices of about a second, after which the effort may change.
  struct Window {
    Duration swept{};
    unsigned slices = 0;
    unsigned late = 0;  // slices that took more than the allowed time
    double spent_s = 0;
    double returns = 0;
    double most_returns_per_s = 0;  // a second of sweep
  };
  struct Level {
    double ratio;           // cost relative to the level below
    Duration hold{};        // pause after the level was too slow
    Duration not_before{};  // earliest next try
  };
  void Reconsider(double cost);
  void LearnRatio(double cost);
  void Lower();

  unsigned effort_ = 1;
  Duration now_{};
  unsigned much_too_late_ = 0;  // slices in a row
  Window window_;
  double cost_below_ = 0;  // cost before the last raise [s per return]; 0: no raise
  std::array<Level, kHighest + 1> levels_ = {{{1}, {5}, {1.7}, {2.7}}};
};

}  // namespace lidar::codec
