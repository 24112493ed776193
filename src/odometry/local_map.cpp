// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/local_map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace lidar::odometry {
namespace {

constexpr std::uint32_t kPointsOfASurface = 8;
/// The greatest variance of points across a surface, as a fraction of the variance along the
/// surface.
constexpr double kFlatness = 0.1;

constexpr std::array<Voxel, 7> kCross = {
    {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

Voxel operator+(const Voxel& a, const Voxel& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

/// Returns the squared distance between a point and a neighbouring cube. `inside` is the point
/// relative to the corner of its own cube. `step` is the index of the neighbouring cube relative to
/// this cube, and `size` is the edge length of a cube.
double SquaredGap(const Eigen::Vector3d& inside, const Voxel& step, double size) {
  const auto gap = [size](double c, std::int32_t s) { return s == 0 ? 0.0 : s > 0 ? size - c : c; };
  const double x = gap(inside.x(), step.x);
  const double y = gap(inside.y(), step.y);
  const double z = gap(inside.z(), step.z);
  return x * x + y * y + z * z;
}

}  // namespace

LocalMap::LocalMap(const LocalMapSettings& settings)
    : settings_(settings), spacing_m_(settings.voxel_size_m / std::sqrt(double{kMaxPoints})) {}

Eigen::Vector3d LocalMap::CornerOf(const Voxel& v) const {
  return Eigen::Vector3d(v.x, v.y, v.z) * settings_.voxel_size_m;
}

LocalMap::Block* LocalMap::BlockAt(const Voxel& voxel) {
  const auto found = index_.find(voxel);
  if (found != index_.end()) return &blocks_[found->second];
  std::uint32_t slot = static_cast<std::uint32_t>(blocks_.size());
  if (free_.empty()) {
    blocks_.emplace_back();
  } else {
    slot = free_.back();
    free_.pop_back();
    blocks_[slot] = {};
  }
  index_.insert({voxel, slot});
  return &blocks_[slot];
}

LocalMap::Block* LocalMap::FindBlock(const Voxel& voxel) {
  const auto found = index_.find(voxel);
  return found == index_.end() ? nullptr : &blocks_[found->second];
}

void LocalMap::Add(const Points& points, const Points& normals) {
  const auto apart = static_cast<float>(spacing_m_ * spacing_m_);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d& point = points[i];
    const Voxel voxel = VoxelOf(point, settings_.voxel_size_m);
    Block& block = *BlockAt(voxel);
    if (block.count == kMaxPoints) continue;
    const Eigen::Vector3f inside = (point - CornerOf(voxel)).cast<float>();
    const auto* end = block.points.begin() + block.count;
    const bool is_new = std::none_of(block.points.cbegin(), end, [&](const Eigen::Vector3f& p) {
      return (p - inside).squaredNorm() < apart;
    });
    if (!is_new) continue;
    block.normals[block.count] = Eigen::Vector3f::Zero();
    if (i < normals.size()) block.normals[block.count] = normals[i].cast<float>();
    block.points[block.count++] = inside;
  }
}

void LocalMap::Forget(const Eigen::Vector3d& center) {
  const double square = settings_.radius_m * settings_.radius_m;
  for (auto it = index_.begin(); it != index_.end();) {
    if ((CornerOf(it->first) - center).squaredNorm() > square) {
      free_.push_back(it->second);
      it = index_.erase(it);
    } else {
      ++it;
    }
  }
}

std::optional<LocalMap::Neighbour> LocalMap::FindNearest(const Eigen::Vector3d& point,
                                                         double reach_m) {
  const double size = settings_.voxel_size_m;
  const Voxel home = VoxelOf(point, size);
  const Eigen::Vector3d inside = point - CornerOf(home);
  auto best = static_cast<float>(reach_m * reach_m);
  Block* found = nullptr;
  Voxel found_step;
  std::uint32_t found_index = 0;
  const auto search = [&](const Voxel& step) {
    if (SquaredGap(inside, step, size) >= static_cast<double>(best)) return;
    Block* block = FindBlock(home + step);
    if (block == nullptr) return;
    const Eigen::Vector3f from =
        (inside - Eigen::Vector3d(step.x, step.y, step.z) * size).cast<float>();
    for (std::uint32_t i = 0; i < block->count; ++i) {
      const float distance = (block->points[i] - from).squaredNorm();
      if (distance >= best) continue;
      best = distance;
      found = block;
      found_step = step;
      found_index = i;
    }
  };
  search({0, 0, 0});
  for (std::int32_t x = -1; x <= 1; ++x)
    for (std::int32_t y = -1; y <= 1; ++y)
      for (std::int32_t z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0) search({x, y, z});
  if (found == nullptr) return std::nullopt;
  const Voxel voxel = home + found_step;
  Neighbour neighbour;
  neighbour.point = CornerOf(voxel) + found->points[found_index].cast<double>();
  neighbour.normal = found->normals[found_index].cast<double>();
  neighbour.has_normal = !neighbour.normal.isZero(0);
  if (neighbour.has_normal) return neighbour;
  if (found->counted != found->count) UpdateNormal(voxel, found);
  neighbour.has_normal = found->has_normal;
  neighbour.normal = found->normal.cast<double>();
  return neighbour;
}

/// Fits a plane to the points of the cube. If the cube has few points, also uses the points of
/// cubes that share a face with it.
void LocalMap::UpdateNormal(const Voxel& voxel, Block* block) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  std::uint32_t count = 0;
  for (const Voxel& step : kCross) {
    if (count >= kPointsOfASurface) break;
    const Block* other = FindBlock(voxel + step);
    if (other == nullptr) continue;
    const Eigen::Vector3d shift = Eigen::Vector3d(step.x, step.y, step.z) * settings_.voxel_size_m;
    for (std::uint32_t i = 0; i < other->count; ++i) {
      const Eigen::Vector3d p = other->points[i].cast<double>() + shift;
      sum += p;
      squares += p * p.transpose();
    }
    count += other->count;
  }
  block->counted = block->count;
  block->has_normal = false;
  if (count < kPointsOfASurface) return;
  const Eigen::Vector3d mean = sum / count;
  const Eigen::Matrix3d covariance = squares / count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  if (solver.eigenvalues()(0) > kFlatness * solver.eigenvalues()(1)) return;
  block->has_normal = true;
  block->normal = solver.eigenvectors().col(0).cast<float>();
}

std::size_t LocalMap::CountPoints() const {
  std::size_t count = 0;
  for (const auto& [voxel, slot] : index_) count += blocks_[slot].count;
  return count;
}

Points LocalMap::Collect() const {
  Points points;
  points.reserve(CountPoints());
  for (const auto& [voxel, slot] : index_)
    for (std::uint32_t i = 0; i < blocks_[slot].count; ++i)
      points.push_back(CornerOf(voxel) + blocks_[slot].points[i].cast<double>());
  return points;
}

}  // namespace lidar::odometry
