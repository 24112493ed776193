// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/view/trail_map.h"

#include <algorithm>
#include <cmath>

namespace lidar::gst {
namespace {

constexpr double kLongestStep_s = 1;  // a longer step is not used to predict poses
constexpr float kGrowth = 1.5F;
constexpr float kNews = 0.3F;      // weight of a new value; a distant point's value may be wrong
constexpr float kFarthest = 1e7F;  // [m]: floats cannot distinguish cubes that are farther away

using Cube = std::array<std::int32_t, 3>;

Cube CubeOf(const std::array<float, 3>& at, float size) {
  const auto index = [size](float c) { return static_cast<std::int32_t>(std::floor(c / size)); };
  return {index(at[0]), index(at[1]), index(at[2])};
}

std::array<float, 9> ToMatrix(const std::array<double, 4>& q) {
  const auto [x, y, z, w] = q;
  const std::array<double, 9> m = {
      1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
      2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
      2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
  std::array<float, 9> rotation{};
  std::transform(m.begin(), m.end(), rotation.begin(), [](double v) { return float(v); });
  return rotation;
}

}  // namespace

float Rigid::heading() const { return std::atan2(rotation[3], rotation[0]); }

TrailMap::TrailMap(std::size_t most_points) : most_points_(most_points) {
  std::size_t slots = 1;
  while (slots < 2 * most_points) slots *= 2;
  slots_.assign(slots, 0);
}

void TrailMap::MoveTo(const GstLidarPose& pose, double seconds) {
  before_ = pose_;
  pose_ = pose;
  step_s_ = poses_ > 0 ? seconds - pose_s_ : 0;
  if (!(step_s_ > 0 && step_s_ < kLongestStep_s)) step_s_ = 0;
  pose_s_ = seconds;
  ++poses_;
  NotePlace();
}

Rigid TrailMap::PoseAfter(double later_s) const {
  const double part = step_s_ > 0 ? later_s / step_s_ : 0;
  std::array<double, 4> q{};
  double dot = 0;
  for (std::size_t i = 0; i < 4; ++i) dot += pose_.orientation[i] * before_.orientation[i];
  const double sign = dot < 0 ? -1 : 1;  // chooses the nearer of the two quaternions of a rotation
  double norm = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    q[i] = pose_.orientation[i] + part * (pose_.orientation[i] - sign * before_.orientation[i]);
    norm += q[i] * q[i];
  }
  if (!(norm > 0)) return {};
  for (double& c : q) c /= std::sqrt(norm);
  Rigid rigid;
  rigid.rotation = ToMatrix(q);
  for (std::size_t i = 0; i < 3; ++i)
    rigid.position[i] =
        static_cast<float>(pose_.position[i] + part * (pose_.position[i] - before_.position[i]));
  return rigid;
}

void TrailMap::NotePlace() {
  std::array<float, 3> place{};
  for (std::size_t i = 0; i < 3; ++i) place[i] = static_cast<float>(pose_.position[i]);
  if (!way_.empty()) {
    float square = 0;
    for (std::size_t i = 0; i < 3; ++i)
      square += (place[i] - way_.back()[i]) * (place[i] - way_.back()[i]);
    if (square < place_step_m_ * place_step_m_) return;
  }
  way_.push_back(place);
  if (way_.size() < kMostPlaces) return;
  for (std::size_t i = 0; 2 * i < way_.size(); ++i) way_[i] = way_[2 * i];
  way_.resize((way_.size() + 1) / 2);
  place_step_m_ *= 2;
}

/// Returns the slot of the point that is in the same cube as `at`, or a free slot if there is none.
std::size_t TrailMap::SlotOf(const std::array<float, 3>& at) const {
  const Cube cube = CubeOf(at, cube_m_);
  const auto part = [](std::int32_t c) { return static_cast<std::uint64_t>(std::uint32_t(c)); };
  std::uint64_t hash = part(cube[0]) * 0x9E3779B97F4A7C15U ^ part(cube[1]) * 0xC2B2AE3D27D4EB4FU ^
                       part(cube[2]) * 0x165667B19E3779F9U;
  hash ^= hash >> 29;
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash & mask;
  while (slots_[slot] != 0 && CubeOf(points_[slots_[slot] - 1].at, cube_m_) != cube)
    slot = (slot + 1) & mask;
  return slot;
}

void TrailMap::Add(const std::array<float, 3>& at, float value) {
  // The comparison is also false for NaN.
  if (!std::all_of(at.begin(), at.end(), [](float c) { return std::abs(c) < kFarthest; })) return;
  const std::size_t slot = SlotOf(at);
  if (slots_[slot] != 0) {
    Point& there = points_[slots_[slot] - 1];
    if (there.last_scan == scan_) return;
    there.value += kNews * (value - there.value);
    there.last_scan = scan_;
    if (there.scans < UINT16_MAX) ++there.scans;
    return;
  }
  points_.push_back({at, value, scan_, 1});
  slots_[slot] = static_cast<std::uint32_t>(points_.size());
  if (points_.size() == most_points_) Coarsen();
}

void TrailMap::Coarsen() {
  while (points_.size() > most_points_ / 4 * 3) {
    cube_m_ *= kGrowth;
    const std::vector<Point> all = std::move(points_);
    points_.clear();
    std::fill(slots_.begin(), slots_.end(), 0);
    for (const Point& point : all) {
      const std::size_t slot = SlotOf(point.at);
      if (slots_[slot] != 0) {
        Point& kept = points_[slots_[slot] - 1];
        kept.scans = std::max(kept.scans, point.scans);
        continue;
      }
      points_.push_back(point);
      slots_[slot] = static_cast<std::uint32_t>(points_.size());
    }
  }
}

}  // namespace lidar::gst
