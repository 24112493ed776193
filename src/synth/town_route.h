// SPDX-License-Identifier: LGPL-2.1-or-later
// An endless round trip through the streets of a town.
#pragma once
#include <vector>

#include "src/synth/trajectory.h"

namespace lidar::synth {

class TownRoute final : public Route {
 public:
  explicit TownRoute(double speed_mps);

  Place At(double seconds) const override;
  double lap_m() const { return length_m_; }
  double lap_s() const { return times_.back(); }  // 0: the car does not move

 private:
  struct Point {
    double x = 0;
    double y = 0;
  };
  void MakePoints();
  void MakeTimes(double speed_mps);
  const Point& PointAt(std::size_t i) const { return points_[i % points_.size()]; }
  double LengthOf(std::size_t i) const;  // distance from point i to the next one

  std::vector<Point> points_;  // the route is closed: the first point follows the last one
  double length_m_ = 0;
  std::vector<double> distances_;  // driven distance at each point, and at the end of the lap
  std::vector<double> speeds_;
  std::vector<double> times_;
};

}  // namespace lidar::synth
