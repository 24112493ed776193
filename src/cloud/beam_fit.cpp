// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/beam_fit.h"

#include <algorithm>
#include <cmath>

#include "src/cloud/point_math.h"

namespace lidar {
namespace {

constexpr std::uint32_t kSpan = 16;        // columns between two points that show the turn
constexpr std::size_t kFewestPairs = 100;  // of such points
constexpr double kFewestReturns = 3;       // of a beam whose line is its own
constexpr int kRounds = 200;               // of lines and origin in turn: both settle well before
constexpr int kPowerSteps = 8;
constexpr double kNoOrigin_m = 1e-4;  // shorter than that, the origin has no direction

double Degrees(double radians) { return radians * 180 / kPi; }
double Wrap(double radians) { return std::remainder(radians, 2 * kPi); }

std::array<double, 3> Normalised(const std::array<double, 3>& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (length == 0) return {1, 0, 0};
  return {v[0] / length, v[1] / length, v[2] / length};
}

double Determinant(const std::array<double, 9>& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

}  // namespace

/// The median of how far the azimuth turns between points of a row.
bool BeamFit::FindTurn(const std::uint8_t* xyz, std::size_t point_step) {
  if (width_ <= kSpan) return false;
  std::vector<double> steps;
  const auto at = [&](std::size_t row, std::size_t column) {
    return PositionAt(xyz + (row * width_ + column) * point_step);
  };
  for (std::size_t row = 0; row < beams_.size(); ++row) {
    for (std::size_t column = 0; column + kSpan < width_; column += kSpan) {
      const auto a = at(row, column);
      const auto b = at(row, column + kSpan);
      if (!IsReturn(a) || !IsReturn(b)) continue;
      const auto azimuth = [](const auto& p) { return std::atan2(double{p[1]}, double{p[0]}); };
      steps.push_back(Wrap(azimuth(b) - azimuth(a)) / kSpan);
    }
  }
  if (steps.size() < kFewestPairs) return false;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double columns = 2 * kPi / std::abs(*middle);
  if (!(columns < SensorModel::kMaxColumns) || std::lround(columns) < std::int64_t{width_})
    return false;
  columns_per_turn_ = static_cast<std::uint32_t>(std::lround(columns));
  counter_clockwise_ = *middle > 0;
  return true;
}

void BeamFit::Add(const std::uint8_t* xyz, std::size_t point_step) {
  if (columns_per_turn_ == 0 && !FindTurn(xyz, point_step)) return;
  for (std::uint32_t column = 0; column < width_; ++column) {
    const double turned = 2 * kPi * column / columns_per_turn_;  // against the encoder
    const double c = std::cos(turned);
    const double s = std::sin(turned);
    for (std::size_t row = 0; row < beams_.size(); ++row) {
      const auto p = PositionAt(xyz + (row * width_ + column) * point_step);
      if (!IsReturn(p)) continue;
      const double x = double{p[0]};
      const double y = counter_clockwise_ ? -double{p[1]} : double{p[1]};
      const Vector v = {x * c - y * s, x * s + y * c, double{p[2]}};
      Moments& m = beams_[row];
      ++m.count;
      for (std::size_t i = 0; i < 3; ++i) {
        m.sum[i] += v[i];
        for (std::size_t j = 0; j < 3; ++j) m.products[3 * i + j] += v[i] * v[j];
      }
    }
  }
}

/// Along which the points lie, seen from `origin`.
BeamFit::Vector BeamFit::DirectionOf(const Moments& m, const Vector& origin, const Vector& guess) {
  std::array<double, 9> spread;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      spread[3 * i + j] = m.products[3 * i + j] - origin[i] * m.sum[j] - m.sum[i] * origin[j] +
                          m.count * origin[i] * origin[j];
  Vector d = guess;
  for (int step = 0; step < kPowerSteps; ++step) {
    Vector next{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) next[i] += spread[3 * i + j] * d[j];
    d = Normalised(next);
  }
  return d;
}

/// The point that is nearest to all lines; each goes through its points' middle.
std::optional<BeamFit::Vector> BeamFit::OriginOf(const std::vector<Moments>& beams,
                                                 const std::vector<Vector>& directions) {
  std::array<double, 9> a{};
  Vector b{};
  for (std::size_t k = 0; k < beams.size(); ++k) {
    const Vector& d = directions[k];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const double across = (i == j ? 1 : 0) - d[i] * d[j];
        a[3 * i + j] += beams[k].count * across;
        b[i] += across * beams[k].sum[j];
      }
    }
  }
  const double determinant = Determinant(a);
  if (!(std::abs(determinant) > 1e-9)) return std::nullopt;
  Vector origin;
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<double, 9> replaced = a;
    for (std::size_t row = 0; row < 3; ++row) replaced[3 * row + i] = b[row];
    origin[i] = Determinant(replaced) / determinant;
  }
  return origin;
}

BeamFit::Lines BeamFit::FitLines() const {
  Lines lines;
  for (const Moments& m : beams_) lines.directions.push_back(Normalised(m.sum));
  for (int round = 0; round < kRounds; ++round) {
    const auto origin = OriginOf(beams_, lines.directions);
    if (!origin) break;
    lines.origin = *origin;
    for (std::size_t k = 0; k < beams_.size(); ++k)
      if (beams_[k].count >= kFewestReturns)
        lines.directions[k] = DirectionOf(beams_[k], lines.origin, lines.directions[k]);
  }
  return lines;
}

/// A beam that has not seen anything stands midway between its neighbours that have.
void BeamFit::FillGaps(std::vector<Beam>* beams) const {
  const auto known = [&](std::size_t k) { return beams_[k].count >= kFewestReturns; };
  for (std::size_t k = 0; k < beams->size(); ++k) {
    if (known(k)) continue;
    std::size_t above = k;
    std::size_t below = k;
    while (above > 0 && !known(above)) --above;
    while (below + 1 < beams->size() && !known(below)) ++below;
    if (!known(above)) above = below;
    if (!known(below)) below = above;
    const Beam& a = (*beams)[above];
    const Beam& b = (*beams)[below];
    const double share =
        above == below ? 0 : static_cast<double>(k - above) / static_cast<double>(below - above);
    (*beams)[k].azimuth_deg = a.azimuth_deg;
    (*beams)[k].altitude_deg = a.altitude_deg + share * (b.altitude_deg - a.altitude_deg);
  }
}

std::optional<SensorModel> BeamFit::Fit() const {
  const auto seen = std::count_if(beams_.begin(), beams_.end(),
                                  [](const Moments& m) { return m.count >= kFewestReturns; });
  if (columns_per_turn_ == 0 || seen < 2 || beams_.size() > SensorModel::kMaxBeams)
    return std::nullopt;
  const Lines lines = FitLines();
  SensorModel model;
  model.columns_per_scan = columns_per_turn_;
  model.beam_to_lidar_x_m = std::hypot(lines.origin[0], lines.origin[1]);
  // The lidar's x axis is where the beams begin; without an origin of their own it may be anywhere.
  const double turn =
      model.beam_to_lidar_x_m > kNoOrigin_m ? std::atan2(lines.origin[1], lines.origin[0]) : 0;
  const double c = std::cos(turn);
  const double s = std::sin(turn);
  const double side = counter_clockwise_ ? -1 : 1;
  model.lidar_to_sensor = {c, -s, 0, 0, side * s, side * c, 0, 0, 0, 0, 1, lines.origin[2],
                           0, 0,  0, 1};
  for (const Vector& d : lines.directions) {
    const double azimuth = Wrap(std::atan2(d[1], d[0]) - turn);
    model.beams.push_back({-Degrees(azimuth), Degrees(std::asin(std::clamp(d[2], -1., 1.))), 0});
  }
  FillGaps(&model.beams);
  return model;
}

}  // namespace lidar
