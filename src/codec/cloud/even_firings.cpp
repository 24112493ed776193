// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/even_firings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lidar::codec::cloud {
namespace {

double ElevationOf(const Sighting& s) { return std::atan2(s.z_m, s.rho_m) / kRadians; }

/// Follows azimuths that rise, or fall, by `step` from one firing to the next.
class FiringCounter {
 public:
  FiringCounter(std::int32_t first, double step) : last_(first), step_(step) {}
  /// Returns the firing of the next azimuth, which is less than a turn ahead.
  double Next(std::int32_t azimuth) {
    const double turn = kTurn / std::abs(step_);
    const double further = (azimuth - last_) / step_;
    last_ = azimuth;
    firing_ += std::round(further - turn * std::floor((further + 0.5) / turn));
    return firing_ = std::max(firing_, 0.0);
  }

 private:
  std::int32_t last_;
  double step_;
  double firing_ = 0;
};

/// A line through the errors of azimuths.
class AzimuthLine {
 public:
  void Add(double firing, double away) {
    n_ += 1;
    x_ += firing;
    y_ += away;
    xx_ += firing * firing;
    xy_ += firing * away;
  }
  double slope() const {
    const double spread = n_ * xx_ - x_ * x_;
    return spread > 0 ? (n_ * xy_ - x_ * y_) / spread : 0;
  }
  double start() const { return (y_ - slope() * x_) / n_; }

 private:
  double n_ = 0;
  double x_ = 0;
  double y_ = 0;
  double xx_ = 0;
  double xy_ = 0;
};

/// Makes the samples. Returns false if there are too many firings.
bool CountFirings(const std::vector<Sighting>& points, EvenFirings* firings) {
  constexpr double kMostFirings = kMostLines * BeamTable::kMostColumns;
  FiringCounter counter(points[0].azimuth, firings->step);
  firings->samples.clear();
  for (const Sighting& s : points) {
    const double firing = counter.Next(s.azimuth);
    if (firing >= kMostFirings) return false;
    firings->samples.push_back({firing, ElevationOf(s)});
    firings->count = static_cast<std::uint32_t>(firing) + 1;
  }
  return true;
}

/// Returns the distance of an azimuth from its firing.
double AwayFrom(const EvenFirings& firings, const Sighting& s, double firing) {
  return std::remainder(s.azimuth - firings.first - firings.step * firing, kTurn);
}

/// Fits the firings to the azimuths.
void Align(const std::vector<Sighting>& points, EvenFirings* firings) {
  AzimuthLine line;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double firing = firings->samples[i].firing;
    line.Add(firing, AwayFrom(*firings, points[i], firing));
  }
  firings->first += line.start();
  firings->step += line.slope();
}

/// Returns true if most azimuths are near their firing.
bool AreEven(const std::vector<Sighting>& points, const EvenFirings& firings) {
  constexpr double kNear = 0.1;  // steps
  std::size_t near = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double away = AwayFrom(firings, points[i], firings.samples[i].firing);
    if (std::abs(away) < kNear * std::abs(firings.step)) ++near;
  }
  return near > points.size() * 3 / 4;
}

}  // namespace

std::optional<EvenFirings> FindFirings(const std::vector<Sighting>& points) {
  constexpr double kLeastStep = 64;  // many times the rounding of coordinates
  constexpr std::size_t kLeastPoints = 64;
  if (points.size() < kLeastPoints) return std::nullopt;
  std::vector<std::int32_t> steps;
  for (std::size_t i = 1; i < points.size(); ++i)
    steps.push_back(Wrapped(points[i].azimuth - points[i - 1].azimuth));
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  EvenFirings firings;
  firings.first = points[0].azimuth;
  firings.step = *middle;
  const auto is_usual = [&] {
    return std::abs(firings.step) > kLeastStep && std::abs(firings.step) < kTurn / 16;
  };
  if (!is_usual() || !CountFirings(points, &firings)) return std::nullopt;
  Align(points, &firings);
  if (!is_usual() || !CountFirings(points, &firings) || !AreEven(points, firings))
    return std::nullopt;
  return firings;
}

}  // namespace lidar::codec::cloud
