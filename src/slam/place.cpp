// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/slam/place.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <unsupported/Eigen/FFT>

namespace lidar::slam {
namespace {

using odometry::Points;
using odometry::Pose;

constexpr double kGroundCell = 2;     // [m]
constexpr int kGroundCells = 64;      // number of cells along each side
constexpr double kAboveGround = 0.7;  // points that are higher are above the ground [m]
constexpr float kMostDense = 8;       // limit for the count of a cell, which walls reach
constexpr double kYawStep = 0.035;    // two degrees
constexpr int kElsewhere = 6;         // least distance to a second peak [cells]
constexpr std::size_t kLeastGround = 30;

using Density = Place::Density;

/// Computes the Fourier transform of all rows and then of all columns, in place.
void Transform(Density* map, bool forward) {
  Eigen::FFT<float> fft;
  Eigen::VectorXcf in(Place::kCells);
  Eigen::VectorXcf out(Place::kCells);
  for (const bool rows : {true, false}) {
    for (Eigen::Index i = 0; i < Place::kCells; ++i) {
      if (rows) {
        in = map->row(i).matrix().transpose();
      } else {
        in = map->col(i).matrix();
      }
      if (forward) {
        fft.fwd(out, in);
      } else {
        fft.inv(out, in);
      }
      if (rows) {
        map->row(i) = out.array().transpose();
      } else {
        map->col(i) = out.array();
      }
    }
  }
}

int CellOf(double c) { return static_cast<int>(std::floor(c)) + Place::kCells / 2; }
bool IsCell(int i) { return i >= 0 && i < Place::kCells; }

/// Returns the number of points above the ground in each cell. The points are first rotated by
/// `yaw`.
Density Count(const Points& standing, double yaw) {
  Eigen::ArrayXXf counts = Eigen::ArrayXXf::Zero(Place::kCells, Place::kCells);
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  for (const Eigen::Vector3d& p : standing) {
    const int x = CellOf(c * p.x() - s * p.y());
    const int y = CellOf(s * p.x() + c * p.y());
    if (!IsCell(x) || !IsCell(y)) continue;
    counts(x, y) = std::min(counts(x, y) + 1, kMostDense);
  }
  return counts.cast<std::complex<float>>();
}

struct Peak {
  float value = 0;
  double yaw = 0;
  int x = 0;
  int y = 0;
};

int Signed(Eigen::Index i) {
  return static_cast<int>(i < Place::kCells / 2 ? i : i - Place::kCells);
}

/// Returns the highest peak of a correlation, and the highest value that is at least kElsewhere
/// away from this peak.
std::pair<Peak, float> FindPeak(const Density& correlation) {
  Eigen::ArrayXXf real = correlation.real();
  Peak peak;
  Eigen::Index row = 0;
  Eigen::Index column = 0;
  peak.value = real.maxCoeff(&row, &column);
  peak.x = Signed(row);
  peak.y = Signed(column);
  const int mask = Place::kCells - 1;
  for (int dx = -kElsewhere; dx <= kElsewhere; ++dx)
    for (int dy = -kElsewhere; dy <= kElsewhere; ++dy)
      real((peak.x + dx) & mask, (peak.y + dy) & mask) = 0;
  return {peak, real.maxCoeff()};
}

/// Raises and tilts `b` so that its ground coincides with the ground of `a`. Returns false if they
/// have no common ground.
bool MeetGround(const Place& a, const Place& b, Pose* pose) {
  for (int round = 0; round < 3; ++round) {
    Eigen::Matrix3d lhs = 1e-3 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
    std::vector<std::pair<Eigen::Vector3d, double>> gaps;
    for (const Eigen::Vector3d& p : b.ground()) {
      const Eigen::Vector3d there = *pose * p;
      const double gap = static_cast<double>(a.LowestAt(there.x(), there.y())) - there.z();
      if (std::isfinite(gap)) gaps.emplace_back(there, gap);
    }
    if (gaps.size() < kLeastGround) return false;
    const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
    std::nth_element(gaps.begin(), middle, gaps.end(),
                     [](const auto& x, const auto& y) { return x.second < y.second; });
    const double median = middle->second;
    // Only gaps near the median are used, because cars and walls are outliers.
    const double reach = round == 0 ? 3 : 1;
    for (const auto& [p, gap] : gaps) {
      if (std::abs(gap - median) > reach) continue;
      // A translation along z, and rotations about x and y.
      const Eigen::Vector3d row(1, p.y(), -p.x());
      lhs += row * row.transpose();
      rhs += row * gap;
    }
    const Eigen::Vector3d step = lhs.ldlt().solve(rhs);
    odometry::Twist twist = odometry::Twist::Zero();
    twist(2) = step(0);
    twist(3) = step(1);
    twist(4) = step(2);
    *pose = odometry::Exp(twist) * *pose;
  }
  return true;
}

}  // namespace

Place::Place(const Points& points) {
  lowest_ = Eigen::ArrayXXf::Constant(kGroundCells, kGroundCells,
                                      std::numeric_limits<float>::quiet_NaN());
  const auto cell = [](double c) {
    return static_cast<Eigen::Index>(std::floor(c / kGroundCell)) + kGroundCells / 2;
  };
  const auto inside = [](const Eigen::Vector3d& p) {
    return std::max(std::abs(p.x()), std::abs(p.y())) < kRadius;
  };
  for (const Eigen::Vector3d& p : points) {
    if (!inside(p)) continue;
    float& low = lowest_(cell(p.x()), cell(p.y()));
    if (!(low <= static_cast<float>(p.z()))) low = static_cast<float>(p.z());
  }
  for (const Eigen::Vector3d& p : points) {
    if (!inside(p)) continue;
    const double height = p.z() - static_cast<double>(lowest_(cell(p.x()), cell(p.y())));
    if (height > kAboveGround) standing_.push_back(p);
    if (height <= 0) ground_.push_back(p);
  }
  spectrum_ = Count(standing_, 0);
  energy_ = static_cast<double>(spectrum_.real().square().sum());
  Transform(&spectrum_, true);
}

float Place::LowestAt(double x, double y) const {
  if (!(std::max(std::abs(x), std::abs(y)) < kRadius))
    return std::numeric_limits<float>::quiet_NaN();
  return lowest_(static_cast<Eigen::Index>(std::floor(x / kGroundCell)) + kGroundCells / 2,
                 static_cast<Eigen::Index>(std::floor(y / kGroundCell)) + kGroundCells / 2);
}

std::optional<PlaceMatch> Match(const Place& a, const Place& b, double yaw, double yaw_range) {
  Peak best;
  float elsewhere = 0;
  for (double turn = -yaw_range; turn <= yaw_range; turn += kYawStep) {
    Density map = Count(b.standing(), yaw + turn);
    Transform(&map, true);
    map = a.spectrum() * map.conjugate();
    Transform(&map, false);
    auto [peak, other] = FindPeak(map);
    peak.yaw = yaw + turn;
    if (peak.value <= best.value) continue;
    best = peak;
    elsewhere = other;
  }
  const double most = std::sqrt(a.energy() * b.energy());
  if (!(most > 0) || best.value <= 0) return std::nullopt;
  PlaceMatch match;
  match.score = static_cast<double>(best.value) / most;
  match.distinct = static_cast<double>(best.value / std::max(elsewhere, 1e-6F));
  match.pose.rotation = Eigen::AngleAxisd(best.yaw, Eigen::Vector3d::UnitZ());
  match.pose.position = {double(best.x), double(best.y), 0};
  if (!MeetGround(a, b, &match.pose)) return std::nullopt;
  return match;
}

}  // namespace lidar::slam
