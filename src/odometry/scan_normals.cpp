// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/scan_normals.h"

#include <algorithm>
#include <cmath>

namespace lidar::odometry {
namespace {

constexpr int kBins = 1024;  // number of azimuth bins, a power of two
/// The length to each side of a point over which returns are averaged. It is long enough to average
/// the noise of grass, and covers at least two degrees.
constexpr float kSide_m = 0.6F;
constexpr float kLeastBins = 6;
constexpr float kMostBins = 24;
/// Number of bins to each side over which the position of a point is averaged. More bins would
/// round off kerbs and window frames.
constexpr int kBesides = 3;
constexpr std::size_t kSums = kBins + 1;  // number of partial sums in a ring
constexpr float kBinsPerRadian = kBins / 6.2831853F;
/// The least and the greatest distance between two rings, as a difference of the sines of their
/// elevation. Closer rings give noisy normals. Rings that are farther apart may hit different
/// surfaces.
constexpr double kLeastStep = 0.02;
constexpr double kLargestStep = 0.14;
constexpr float kFarthest_m = 1e4F;
/// The greatest distance of a return from its plane. kRoughness_m allows for noise and grass. kBend
/// times the distance of the outer rings allows for curvature. The sum is limited to kMostRough_m.
constexpr float kRoughness_m = 0.05F;
constexpr float kBend = 0.03F;
constexpr float kMostRough_m = 0.2F;
// The least sine of the angle between the two directions that span a plane.
constexpr float kLeastSine = 0.3F;

/// Returns false if `p` is a missing return: NaN, infinite, or the origin.
bool IsReturn(const Eigen::Vector3f& p) {
  const float range = p.norm();
  return range > 0 && range < kFarthest_m;
}

int BinOf(float x, float y) {
  return static_cast<int>(std::floor(std::atan2(y, x) * kBinsPerRadian)) & (kBins - 1);
}

}  // namespace

ScanNormals::ScanNormals(const Points& points, const std::vector<std::uint16_t>& rings) {
  if (rings.size() != points.size() || rings.empty()) return;
  const std::size_t count = std::size_t{1} + *std::max_element(rings.begin(), rings.end());
  rings_.resize(std::min(count, kMaxRings));
  std::vector<Eigen::Vector3f> image(rings_.size() * kBins, Eigen::Vector3f::Zero());
  std::vector<int> seen(rings_.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (rings[i] >= rings_.size()) continue;
    const Eigen::Vector3f p = points[i].cast<float>();
    if (!IsReturn(p)) continue;
    Ring& ring = rings_[rings[i]];
    ring.height += static_cast<double>(p.z() / p.norm());
    ++seen[rings[i]];
    image[rings[i] * std::size_t{kBins} + static_cast<std::size_t>(BinOf(p.x(), p.y()))] = p;
  }
  for (std::size_t r = 0; r < rings_.size(); ++r) {
    rings_[r].seen = seen[r] > 0;
    if (rings_[r].seen) rings_[r].height /= seen[r];
  }
  FindNeighbours();
  SumUp(image);
}

void ScanNormals::FindNeighbours() {
  std::vector<int> order;
  for (std::size_t r = 0; r < rings_.size(); ++r)
    if (rings_[r].seen) order.push_back(static_cast<int>(r));
  const auto height = [this](int r) { return rings_[static_cast<std::size_t>(r)].height; };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return height(a) < height(b); });
  for (std::size_t i = 0, j = 0; i < order.size(); ++i) {
    while (j < order.size() && height(order[j]) < height(order[i]) + kLeastStep) ++j;
    if (j < order.size() && height(order[j]) < height(order[i]) + kLargestStep)
      rings_[static_cast<std::size_t>(order[i])].above = order[j];
  }
  for (std::size_t i = order.size(), j = order.size(); i-- > 0;) {
    while (j > 0 && height(order[j - 1]) > height(order[i]) - kLeastStep) --j;
    if (j > 0 && height(order[j - 1]) > height(order[i]) - kLargestStep)
      rings_[static_cast<std::size_t>(order[i])].below = order[j - 1];
  }
}

void ScanNormals::SumUp(const std::vector<Eigen::Vector3f>& image) {
  sums_.assign(rings_.size() * kSums, Eigen::Vector4d::Zero());
  for (std::size_t r = 0; r < rings_.size(); ++r) {
    const Eigen::Vector3f* row = &image[r * kBins];
    Eigen::Vector4d* sums = &sums_[r * kSums];
    for (std::size_t i = 0; i < kBins; ++i) {
      sums[i + 1] = sums[i];
      if (!row[i].isZero(0)) sums[i + 1] += row[i].cast<double>().homogeneous();
    }
  }
}

/// Returns the mean of the ring's returns in `bins` bins, which may wrap around the end of the
/// turn.
ScanNormals::Side ScanNormals::MeanOf(int ring, int first_bin, int bins) const {
  const Eigen::Vector4d* sums = &sums_[static_cast<std::size_t>(ring) * kSums];
  const int first = first_bin & (kBins - 1);
  const int end = first + bins;
  Eigen::Vector4d sum = sums[std::min(end, kBins)] - sums[first];
  if (end > kBins) sum += sums[end - kBins];
  if (sum.w() < 0.5) return {};
  return {(sum.head<3>() / sum.w()).cast<float>(), true};
}

/// Fits a plane to the returns on both sides of `bin` in three rings. The lowest ring is the first.
std::optional<Eigen::Vector3f> ScanNormals::FitPlane(const int (&rings)[3], int bin,
                                                     const Eigen::Vector3f& point) const {
  const int bins =
      static_cast<int>(std::clamp(kSide_m * kBinsPerRadian / point.norm(), kLeastBins, kMostBins));
  Side left[3];
  Side right[3];
  Eigen::Vector3f across = Eigen::Vector3f::Zero();
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (int i = 0; i < 3; ++i) {
    if (rings[i] < 0) return std::nullopt;
    left[i] = MeanOf(rings[i], bin + 1, bins);
    right[i] = MeanOf(rings[i], bin - bins, bins);
    if (!left[i].seen || !right[i].seen) return std::nullopt;
    across += left[i].mean - right[i].mean;
    mean += (left[i].mean + right[i].mean) / 6;
  }
  const Eigen::Vector3f up = (left[2].mean + right[2].mean - left[0].mean - right[0].mean) / 2;
  Eigen::Vector3f normal = across.cross(up);
  const float area = normal.norm();
  if (!(area > kLeastSine * across.norm() * up.norm())) return std::nullopt;
  normal /= area;
  const float rough = std::min(kRoughness_m + kBend * up.norm(), kMostRough_m);
  const auto fits = [&](const Eigen::Vector3f& p) {
    return std::abs(normal.dot(p - mean)) <= rough;
  };
  for (int i = 0; i < 3; ++i)
    if (!fits(left[i].mean) || !fits(right[i].mean)) return std::nullopt;
  return fits(point) ? std::optional(normal) : std::nullopt;
}

ScanNormals::Surface ScanNormals::At(const Eigen::Vector3d& point, std::uint16_t ring) const {
  const Surface none{point, Eigen::Vector3d::Zero()};
  if (ring >= rings_.size() || !rings_[ring].seen) return none;
  const Eigen::Vector3f p = point.cast<float>();
  if (!IsReturn(p)) return none;
  const int bin = BinOf(p.x(), p.y());
  const auto next = [this](int r, bool up) {
    if (r < 0) return -1;
    const Ring& at = rings_[static_cast<std::size_t>(r)];
    return up ? at.above : at.below;
  };
  const int own = ring;
  const int above = next(own, true);
  const int below = next(own, false);
  std::optional<Eigen::Vector3f> found = FitPlane({below, own, above}, bin, p);
  if (!found) found = FitPlane({own, above, next(above, true)}, bin, p);
  if (!found) found = FitPlane({next(below, false), below, own}, bin, p);
  if (!found) return none;
  const Side near = MeanOf(own, bin - kBesides, 2 * kBesides + 1);
  const double above_mean = near.seen ? double{found->dot(p - near.mean)} : 0;
  const Eigen::Vector3d normal = found->cast<double>();
  return {point - above_mean * normal, normal * (found->dot(p) > 0 ? -1 : 1)};
}

}  // namespace lidar::odometry
