// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_lines.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "src/codec/cloud/median.h"

namespace lidar::codec::cloud {
namespace {

/// Limits of elevations, in angle units: the least gap between two beams, and the greatest width of
/// a beam.
constexpr double kGap = 60;         // 0.005 degrees
constexpr double kWidest = 350;     // 0.03 degrees
constexpr std::size_t kFewest = 8;  // points

struct Seen {
  double elevation;
  std::uint32_t point;
};

// The grid of heights and tangents in which lines are searched first.
constexpr double kMostHeight = 0.5;  // [m]
constexpr double kHeightStep = 0.01;
constexpr double kMostTangent = 1.5;
constexpr double kTangentStep = 0.0004;
constexpr auto kTangents = static_cast<std::size_t>(2 * kMostTangent / kTangentStep);
constexpr std::size_t kWindow = 125;  // number of tangents that share a height
constexpr std::size_t kWindows = kTangents / kWindow;
constexpr double kNearest = 1;  // [m]

using Histogram = std::vector<std::uint32_t>;

/// Returns the histogram bin for the tangent of a line. The line leads from the height `height_m`
/// on the z axis to the point. Returns SIZE_MAX if it is too steep.
std::size_t ClassOf(const Sighting& s, double height_m, double classes_per_tangent) {
  const double tangent = (s.z_m - height_m) / s.rho_m;
  if (std::abs(tangent) >= kMostTangent) return SIZE_MAX;
  return static_cast<std::size_t>((tangent + kMostTangent) * classes_per_tangent);
}

/// Returns the best height for each window of tangents. The histogram of the tangents, as seen from
/// this height, has the sharpest peaks.
std::vector<double> SharpestHeights(const std::vector<Sighting>& points) {
  std::vector<double> heights(kWindows, 0);
  std::vector<double> best(kWindows, 0);
  constexpr std::size_t kSample = 40'000;
  const std::size_t stride = points.size() / kSample + 1;
  for (double height = -kMostHeight; height <= kMostHeight; height += kHeightStep) {
    Histogram histogram(kTangents + 1, 0);
    for (std::size_t i = 0; i < points.size(); i += stride) {
      if (points[i].rho_m < kNearest) continue;
      const std::size_t at = ClassOf(points[i], height, 1 / kTangentStep);
      if (at < kTangents) ++histogram[at];
    }
    for (std::size_t w = 0; w < kWindows; ++w) {
      double sharpness = 0;
      for (std::size_t i = w * kWindow; i < (w + 1) * kWindow; ++i)
        sharpness += static_cast<double>(histogram[i]) * static_cast<double>(histogram[i]);
      if (sharpness <= best[w]) continue;
      best[w] = sharpness;
      heights[w] = height;
    }
  }
  return heights;
}

/// Finds lines as peaks in the histogram of tangents. The tangents of each window are seen from the
/// window's own height.
std::vector<BeamLine> FirstLines(const std::vector<Sighting>& points) {
  constexpr std::size_t kFiner = 2;
  constexpr double kPerTangent = kFiner / kTangentStep;
  constexpr std::size_t kReach = 7;  // a tangent of 0.0014, i.e. 0.08 degrees
  const std::vector<double> heights = SharpestHeights(points);
  std::vector<double> histogram(kFiner * kTangents + 1, 0);
  for (const Sighting& s : points) {
    if (s.rho_m < kNearest) continue;
    std::size_t last = SIZE_MAX;
    for (std::size_t w = 0; w < kWindows; ++w) {
      if (w > 0 && heights[w] == heights[w - 1]) continue;
      const std::size_t at = ClassOf(s, heights[w], kPerTangent);
      if (at >= kFiner * kTangents || at == last) continue;
      const std::size_t window = std::min(at / (kFiner * kWindow), kWindows - 1);
      if (heights[window] != heights[w]) continue;
      last = at;
      histogram[at] += 1;
    }
  }
  std::vector<double> smooth(histogram.size(), 0);
  for (std::size_t i = 2; i + 2 < histogram.size(); ++i)
    smooth[i] = histogram[i - 2] + 2 * histogram[i - 1] + 3 * histogram[i] + 2 * histogram[i + 1] +
                histogram[i + 2];
  std::vector<BeamLine> lines;
  for (std::size_t i = smooth.size() - kReach; i-- > kReach;) {
    if (smooth[i] < 9 * 4) continue;
    const auto around = smooth.begin() + static_cast<std::ptrdiff_t>(i);
    if (smooth[i] < *std::max_element(around - kReach, around + kReach + 1)) continue;
    const double tangent = (static_cast<double>(i) + 0.5) / kPerTangent - kMostTangent;
    if (!lines.empty() && lines.back().tangent - tangent < kReach / kPerTangent) continue;
    lines.push_back({tangent, heights[std::min(i / (kFiner * kWindow), kWindows - 1)]});
  }
  return lines;
}

/// Finds the beam whose line is nearest to a point. The constructor sorts the beams.
class NearestLine {
 public:
  explicit NearestLine(std::vector<FoundBeam>* beams) : beams_(*beams) {
    std::sort(beams_.begin(), beams_.end(), [](const FoundBeam& a, const FoundBeam& b) {
      return a.line.tangent > b.line.tangent;
    });
    std::vector<double> heights;
    for (const FoundBeam& beam : beams_) heights.push_back(beam.line.height_m);
    middle_ = MedianOf(heights);
    low_ = heights.empty() ? 0 : *std::min_element(heights.begin(), heights.end());
    high_ = heights.empty() ? 0 : *std::max_element(heights.begin(), heights.end());
  }
  /// Returns the beam whose line is nearest to the point. Returns null if no line is within
  /// `reach_m`. The beam `other_than` is left out.
  FoundBeam* Find(const Sighting& s, double reach_m, const FoundBeam* other_than = nullptr) const {
    constexpr double kSteepest = 1.81;      // at least sqrt(1 + kMostTangent^2)
    constexpr std::ptrdiff_t kAround = 32;  // bounds the time if many lines are near a point
    const double rho = std::max(s.rho_m, 1e-3);
    // Lines with tangents outside of these limits are farther than `reach_m` from the point,
    // whatever their height is.
    const std::ptrdiff_t first = Below((s.z_m - low_ + kSteepest * reach_m) / rho);
    const std::ptrdiff_t end = Below((s.z_m - high_ - kSteepest * reach_m) / rho);
    const std::ptrdiff_t middle = Below((s.z_m - middle_) / rho);
    FoundBeam* nearest = nullptr;
    for (auto i = std::max(first, middle - kAround); i < std::min(end, middle + kAround); ++i) {
      FoundBeam* beam = &beams_[static_cast<std::size_t>(i)];
      const double off = std::abs(beam->line.Above(s));
      if (off >= reach_m || beam == other_than) continue;
      reach_m = off;
      nearest = beam;
    }
    return nearest;
  }

 private:
  /// Returns the number of lines that are steeper than `tangent`.
  std::ptrdiff_t Below(double tangent) const {
    const auto steeper = [](const FoundBeam& b, double t) { return b.line.tangent > t; };
    return std::lower_bound(beams_.begin(), beams_.end(), tangent, steeper) - beams_.begin();
  }

  std::vector<FoundBeam>& beams_;
  double low_;
  double middle_;
  double high_;
};

/// Assigns each point to the beam with the nearest line, if this line is within `reach_m`.
void Assign(const std::vector<Sighting>& points, double reach_m, FoundBeams* found) {
  for (FoundBeam& beam : found->beams) beam.points.clear();
  found->points = 0;
  const NearestLine lines(&found->beams);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    FoundBeam* nearest = lines.Find(points[i], reach_m);
    if (nearest == nullptr) continue;
    nearest->points.push_back(i);
    ++found->points;
  }
}

/// Removes all points from a beam if other beams are near to most of these points, too. Begins with
/// the beam that has the fewest points.
void DropNeedless(const std::vector<Sighting>& points, double reach_m, FoundBeams* found) {
  constexpr double kMost = 0.8;
  const NearestLine lines(&found->beams);
  std::vector<FoundBeam*> rising;
  for (FoundBeam& beam : found->beams) rising.push_back(&beam);
  std::sort(rising.begin(), rising.end(), [](const FoundBeam* a, const FoundBeam* b) {
    return a->points.size() < b->points.size();
  });
  for (FoundBeam* beam : rising) {
    const auto elsewhere =
        std::count_if(beam->points.begin(), beam->points.end(), [&](std::uint32_t p) {
          const FoundBeam* other = lines.Find(points[p], reach_m, beam);
          return other != nullptr && !other->points.empty();  // a dropped beam has no points
        });
    if (static_cast<double>(elsewhere) >= kMost * static_cast<double>(beam->points.size()))
      beam->points.clear();
  }
}

/// Fits the line of a beam to its points by least squares. The old height of the line is a prior.
void Refit(const std::vector<Sighting>& points, FoundBeam* beam) {
  constexpr double kPrior = 0.01;  // weight of the prior for each point [m^2]
  const auto n = static_cast<double>(beam->points.size());
  double rho = 0;
  double z = 0;
  for (const std::uint32_t i : beam->points) {
    rho += points[i].rho_m / n;
    z += points[i].z_m / n;
  }
  double square = 0;
  double product = 0;
  for (const std::uint32_t i : beam->points) {
    const double away = points[i].rho_m - rho;
    square += away * away;
    product += away * (points[i].z_m - z);
  }
  // The prior is the tangent of the line from the old height to the middle of the points.
  const double old = (z - beam->line.height_m) / std::max(rho, 1e-3);
  const double weight = kPrior * n;
  beam->line.tangent = (product + weight * old) / (square + weight);
  beam->line.height_m = z - beam->line.tangent * rho;
}

std::vector<Sighting> Others(const std::vector<Sighting>& points, const FoundBeams& found) {
  std::vector<bool> is_taken(points.size(), false);
  for (const FoundBeam& beam : found.beams)
    for (const std::uint32_t i : beam.points) is_taken[i] = true;
  std::vector<Sighting> others;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!is_taken[i]) others.push_back(points[i]);
  return others;
}

/// Drops beams with too few points or at an implausible height, and sorts the others.
void DropWeakBeams(std::size_t fewest, FoundBeams* found) {
  auto& beams = found->beams;
  beams.erase(std::remove_if(beams.begin(), beams.end(),
                             [&](const FoundBeam& b) {
                               return b.points.size() < fewest ||
                                      std::abs(b.line.height_m) > 2 * kMostHeight;
                             }),
              beams.end());
  std::sort(beams.begin(), beams.end(),
            [](const FoundBeam& a, const FoundBeam& b) { return a.line.tangent > b.line.tangent; });
}

/// Finds bending beams as peaks in the histogram of the elevations.
class BendingBeams {
 public:
  explicit BendingBeams(const std::vector<Sighting>& points) : points_(points) {
    for (const Sighting& s : points)
      classes_.push_back((std::atan2(s.z_m, s.rho_m) / kRadians + kTurn / 4.0) / kClass + kReach);
  }
  FoundBeams Find() {
    FindPeaks();
    FoundBeams found;
    found.beams.resize(peaks_.size());
    for (std::uint32_t i = 0; i < points_.size() && !peaks_.empty(); ++i) {
      const std::size_t nearest = NearestPeak(classes_[i]);
      if (std::abs(peaks_[nearest] - classes_[i]) > kMostAway) continue;
      found.beams[nearest].points.push_back(i);
      ++found.points;
    }
    for (FoundBeam& beam : found.beams) beam.line.tangent = MiddleOf(beam.points);
    DropWeakBeams(kFewest, &found);
    return found;
  }

 private:
  static constexpr double kClass = 58;  // 0.005 degrees
  static constexpr std::size_t kReach = 12;
  static constexpr double kMostAway = 40;
  static constexpr auto kClasses = static_cast<std::size_t>(kTurn / 2 / kClass) + 2 * kReach;

  void FindPeaks() {
    std::vector<double> smooth(kClasses + kReach, 0);
    for (const double at : classes_)
      for (std::size_t i = 0; i <= kReach; ++i) {
        smooth[static_cast<std::size_t>(at) - i] += static_cast<double>(kReach - i);
        smooth[static_cast<std::size_t>(at) + i] += static_cast<double>(kReach - i);
      }
    for (std::size_t i = kClasses; i-- > kReach;) {
      const auto around = smooth.begin() + static_cast<std::ptrdiff_t>(i);
      const auto at = static_cast<double>(i);
      if (smooth[i] < static_cast<double>(kFewest * kReach) ||
          smooth[i] < *std::max_element(around - kReach, around + kReach) ||
          (!peaks_.empty() && peaks_.back() - at < static_cast<double>(kReach))) {
        continue;
      }
      peaks_.push_back(at + 0.5);
    }
  }
  std::size_t NearestPeak(double at) const {
    const auto below = std::lower_bound(peaks_.begin(), peaks_.end(), at, std::greater<>());
    const auto i = static_cast<std::size_t>(below - peaks_.begin());
    if (i == 0) return 0;
    return i == peaks_.size() || peaks_[i - 1] - at < at - peaks_[i] ? i - 1 : i;
  }
  /// Returns the tangent of the point with the median elevation.
  double MiddleOf(std::vector<std::uint32_t> beam) const {
    if (beam.empty()) return 0;
    const auto middle = beam.begin() + static_cast<std::ptrdiff_t>(beam.size() / 2);
    std::nth_element(beam.begin(), middle, beam.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return classes_[a] < classes_[b]; });
    const Sighting& s = points_[*middle];
    return s.z_m / std::max(s.rho_m, 1e-6);
  }

  const std::vector<Sighting>& points_;
  std::vector<double> classes_;  // of the points' elevations, not rounded
  std::vector<double> peaks_;    // in descending order
};

}  // namespace

FoundBeams FindMeetingBeams(const std::vector<Sighting>& points) {
  std::vector<Seen> seen;
  seen.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    seen.push_back({std::atan2(points[i].z_m, points[i].rho_m) / kRadians, i});
  std::sort(seen.begin(), seen.end(),
            [](const Seen& a, const Seen& b) { return a.elevation > b.elevation; });
  FoundBeams found;
  for (std::size_t first = 0; first < seen.size();) {
    std::size_t end = first + 1;
    while (end < seen.size() && seen[end - 1].elevation - seen[end].elevation < kGap) ++end;
    const bool narrow = seen[first].elevation - seen[end - 1].elevation < kWidest;
    if (narrow && end - first >= kFewest) {
      FoundBeam beam;
      beam.line.tangent = std::tan(seen[first + (end - first) / 2].elevation * kRadians);
      for (std::size_t i = first; i < end; ++i) beam.points.push_back(seen[i].point);
      found.points += beam.points.size();
      found.beams.push_back(std::move(beam));
    }
    first = end;
  }
  return found;
}

FoundBeams FindBendingBeams(const std::vector<Sighting>& points) {
  return BendingBeams(points).Find();
}

FoundBeams FindPassingBeams(const std::vector<Sighting>& points) {
  FoundBeams found;
  for (const BeamLine& line : FirstLines(points)) found.beams.push_back({line, {}});
  // The lines found so far are fitted first, and their points are left out. Only then can further
  // lines be found.
  for (const double reach_m : {0.04, 0.02}) {
    Assign(points, reach_m, &found);
    for (FoundBeam& beam : found.beams)
      if (beam.points.size() >= kFewest) Refit(points, &beam);
  }
  Assign(points, 0.02, &found);
  for (const BeamLine& line : FirstLines(Others(points, found))) found.beams.push_back({line, {}});
  DropWeakBeams(0, &found);
  for (const double reach_m : {0.04, 0.03, 0.02, 0.012, 0.008, 0.005, 0.004, 0.003}) {
    Assign(points, reach_m, &found);
    DropWeakBeams(kFewest, &found);
    for (FoundBeam& beam : found.beams) Refit(points, &beam);
  }
  Assign(points, 0.003, &found);
  DropNeedless(points, 0.01, &found);
  DropWeakBeams(kFewest, &found);
  Assign(points, 0.003, &found);
  DropWeakBeams(kFewest, &found);
  return found;
}

}  // namespace lidar::codec::cloud
