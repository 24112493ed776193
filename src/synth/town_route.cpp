// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/town_route.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/synth/street.h"
#include "src/synth/terrain.h"

namespace lidar::synth {
namespace {

/// A crossing at which the route turns, given by its numbers. The route crosses itself at (1, 0).
struct Corner {
  int u, v;
};
constexpr std::array<Corner, 8> kCorners = {
    {{0, 0}, {3, 0}, {3, 2}, {1, 2}, {1, -2}, {-1, -2}, {-1, 0}, {0, 0}}};
constexpr double kCornerRadius = 10;  // for the middle of the street [m]
constexpr double kStep = 0.5;         // distance between points [m]
constexpr double kSideways = 2.5;     // greatest sideways acceleration [m/s^2]
constexpr double kForward = 2;
constexpr double kQuarter = 1.57079632679489661923;

double Plan(int block) { return kFirstCrossing + kCrossingSpacing * block; }

/// A straight part of the route, and a quarter turn around a corner after it, if `turn` is not 0.
struct Leg {
  double u0, v0, du, dv;  // position at which it begins, and its direction
  double straight;
  double turn;  // +1: left, -1: right, 0: straight on
};

int Sign(int v) { return (v > 0) - (v < 0); }

std::vector<Leg> MakeLegs() {
  std::vector<Leg> legs;
  constexpr std::size_t kLegs = kCorners.size() - 1;
  for (std::size_t i = 0; i < kLegs; ++i) {
    const Corner& from = kCorners[i];
    const Corner& to = kCorners[i + 1];
    const Corner& next = kCorners[i + 1 < kLegs ? i + 2 : 1];
    const int du = Sign(to.u - from.u);
    const int dv = Sign(to.v - from.v);
    const int turn = du * Sign(next.v - to.v) - dv * Sign(next.u - to.u);
    // If the route turns at `from`, this leg begins kCornerRadius past `from`. There is no turn
    // before the first leg.
    const Corner& before = kCorners[i > 0 ? i - 1 : kLegs - 1];
    const bool turned = Sign(from.u - before.u) != du || Sign(from.v - before.v) != dv;
    const double skip = turned ? kCornerRadius : 0;
    const double length = kCrossingSpacing * (std::abs(to.u - from.u) + std::abs(to.v - from.v));
    legs.push_back({Plan(from.u) + skip * du, Plan(from.v) + skip * dv, double(du), double(dv),
                    length - skip - (turn != 0 ? kCornerRadius : 0), double(turn)});
  }
  return legs;
}

}  // namespace

TownRoute::TownRoute(double speed_mps) {
  MakePoints();
  MakeTimes(speed_mps);
}

void TownRoute::MakePoints() {
  const double right = kStreetLane;
  const auto add = [this](double u, double v) {
    const Terrain::Point world = Terrain::FromPlan({u, v});
    points_.push_back({world.a, world.b});
  };
  for (const Leg& leg : MakeLegs()) {
    const auto along = [&](double s) {
      add(leg.u0 + s * leg.du + right * leg.dv, leg.v0 + s * leg.dv - right * leg.du);
    };
    const auto count = static_cast<int>(leg.straight / kStep);
    for (int i = 0; i < count; ++i) along(leg.straight * i / count);
    if (leg.turn == 0) continue;
    const double u1 = leg.u0 + leg.straight * leg.du;
    const double v1 = leg.v0 + leg.straight * leg.dv;
    const double mu = u1 - leg.turn * kCornerRadius * leg.dv;  // the middle of the turn
    const double mv = v1 + leg.turn * kCornerRadius * leg.du;
    const double radius = kCornerRadius + leg.turn * right;
    const auto steps = static_cast<int>(radius * kQuarter / kStep);
    for (int i = 0; i < steps; ++i) {
      const double angle = kQuarter * i / steps;
      const double forward = radius * std::sin(angle);
      const double aside = -leg.turn * radius * std::cos(angle);
      add(mu + forward * leg.du - aside * leg.dv, mv + forward * leg.dv + aside * leg.du);
    }
  }
}

double TownRoute::LengthOf(std::size_t i) const {
  return std::hypot(PointAt(i + 1).x - PointAt(i).x, PointAt(i + 1).y - PointAt(i).y);
}

/// Sets the speed at each point. The speed is limited by the curve, and by braking for later
/// curves.
void TownRoute::MakeTimes(double speed_mps) {
  const std::size_t n = points_.size();
  distances_.assign(1, 0);
  speeds_.assign(n + 1, speed_mps);
  for (std::size_t i = 0; i < n; ++i) {
    distances_.push_back(distances_.back() + LengthOf(i));
    const Point& a = PointAt(i + n - 4);
    const Point& b = PointAt(i);
    const Point& c = PointAt(i + 4);
    const double turned = std::remainder(
        std::atan2(c.y - b.y, c.x - b.x) - std::atan2(b.y - a.y, b.x - a.x), 4 * kQuarter);
    const double curvature = std::abs(turned) / (4 * kStep);
    speeds_[i] = std::min(speed_mps, std::sqrt(kSideways / std::max(curvature, 1e-6)));
  }
  length_m_ = distances_.back();
  // Goes around twice, so that the speeds at the end of the lap match those at its beginning.
  const auto limit = [&](std::size_t at, std::size_t from) {
    const double reach = 2 * kForward * LengthOf(std::min(at, from) % n);
    speeds_[at % n] =
        std::min(speeds_[at % n], std::sqrt(speeds_[from % n] * speeds_[from % n] + reach));
  };
  for (std::size_t i = 0; i < 2 * n; ++i) limit(i + 1, i);
  for (std::size_t i = 2 * n; i > 0; --i) limit(i - 1, i);
  speeds_[n] = speeds_[0];
  times_.assign(1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const double mean = (speeds_[i] + speeds_[i + 1]) / 2;
    times_.push_back(mean > 0 ? times_.back() + LengthOf(i) / mean : 0);
  }
}

Route::Place TownRoute::At(double seconds) const {
  const double lap = lap_s() > 0 ? std::floor(seconds / lap_s()) : 0;
  const double t = lap_s() > 0 ? seconds - lap * lap_s() : 0;
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
  const auto i = lap_s() > 0 ? static_cast<std::size_t>(after - times_.begin()) - 1 : 0;
  const double elapsed = t - times_[i];
  const double whole = times_[i + 1] - times_[i];
  const double gain = whole > 0 ? (speeds_[i + 1] - speeds_[i]) / whole : 0;
  const double driven = lap_s() > 0 ? speeds_[i] * elapsed + gain * elapsed * elapsed / 2 : 0;
  const double f = driven / LengthOf(i);
  // Interpolates by a Catmull-Rom curve through the points.
  const std::size_t n = points_.size();
  const auto curve = [&](double Point::*c) {
    const double a = PointAt(i + n - 1).*c, b = PointAt(i).*c, d = PointAt(i + 1).*c,
                 e = PointAt(i + 2).*c;
    const double p1 = (d - a) / 2, p2 = a - 2.5 * b + 2 * d - e / 2,
                 p3 = (e - a) / 2 + 1.5 * (b - d);
    return std::pair(b + f * (p1 + f * (p2 + f * p3)), p1 + f * (2 * p2 + 3 * f * p3));
  };
  const auto [x, dx] = curve(&Point::x);
  const auto [y, dy] = curve(&Point::y);
  const Terrain::Ground ground = Terrain::At({x, y});
  const double yaw = std::atan2(dy, dx);
  Place place;
  place.x = x;
  place.y = y;
  place.z = ground.height;
  place.yaw = yaw;
  place.grade = ground.slope_x * std::cos(yaw) + ground.slope_y * std::sin(yaw);
  place.bank = ground.slope_y * std::cos(yaw) - ground.slope_x * std::sin(yaw);
  place.distance = lap * length_m_ + distances_[i] + driven;
  return place;
}

}  // namespace lidar::synth
