// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/lidar_eval/slam_run.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <stdexcept>

#include "src/cloud/range_grid.h"
#include "src/slam/loop_closer.h"
#include "src/synth/imu.h"

namespace lidar::tools {
namespace {

constexpr std::size_t kStart = 20;  // number of scans that count as the start
constexpr std::uint64_t kImuSeed = 7;

/// Rounds points to the grid that Draco lays over the bounding cube of a cloud.
void QuantizeCube(unsigned bits, odometry::Points* points) {
  if (points->empty()) return;
  Eigen::Vector3d low = points->front();
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3d& p : *points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double step = (high - low).maxCoeff() / (std::ldexp(1.0, static_cast<int>(bits)) - 1);
  if (step <= 0) return;
  for (Eigen::Vector3d& p : *points) p = low + step * ((p - low) / step).array().round().matrix();
}

odometry::TimedPoints OrganisedPoints(const Scan& scan, double range_step_m) {
  const ScanGeometry& geometry = *scan.geometry;
  const std::uint32_t columns = geometry.model.columns_per_scan;
  std::vector<std::uint32_t> ranges = scan.ranges;
  if (range_step_m > 0) {
    const RangeGrid grid = RangeGrid::ForStep(range_step_m, geometry.model.range_unit_mm);
    for (std::uint32_t& range : ranges)
      if (range != 0) range = grid.RangeOf(grid.BinOf(range));
  }
  std::vector<float> xyz(3 * ranges.size());
  geometry.projection.Project(ranges.data(), {0, columns},
                              reinterpret_cast<std::uint8_t*>(xyz.data()), 3 * sizeof(float));
  odometry::TimedPoints timed;
  timed.points.reserve(ranges.size());
  timed.phases.reserve(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (ranges[i] == 0) continue;
    timed.points.push_back(Eigen::Map<const Eigen::Vector3f>(&xyz[3 * i]).cast<double>());
    timed.phases.push_back(static_cast<float>(i % columns) / static_cast<float>(columns));
    timed.rings.push_back(static_cast<std::uint16_t>(i / columns));
  }
  return timed;
}

/// The sum and the largest of the distances between points and their decoded positions.
struct PointErrors {
  double sum_m = 0;
  double max_m = 0;
  double count = 0;

  void Add(const odometry::Points& points, const odometry::Points& coded) {
    for (std::size_t i = 0; i < std::min(points.size(), coded.size()); ++i) {
      const double off = (points[i] - coded[i]).norm();
      if (!std::isfinite(off)) continue;
      sum_m += off;
      max_m = std::max(max_m, off);
      ++count;
    }
  }
};

odometry::Pose ToPose(const synth::Pose& pose) {
  const auto [x, y, z, w] = pose.ToQuaternion();
  return {Eigen::Quaterniond(w, x, y, z), {pose.x, pose.y, pose.z}};
}

/// Makes an IMU that moves along the synthetic drive. Returns null if options.gyroscope is false.
std::unique_ptr<synth::Imu> MakeImu(const ScanStream& scans, const SlamOptions& options) {
  if (!options.gyroscope) return nullptr;
  if (scans.trajectory() == nullptr)
    throw std::runtime_error("only synthetic drives have a gyroscope");
  return std::make_unique<synth::Imu>(*scans.trajectory(), synth::kMemsImu, kImuSeed);
}

}  // namespace

odometry::Pose TrueMiddle(const TimedScan& scan) { return ToPose(*scan.truth); }

std::vector<odometry::Twist> ErrorsOf(const SlamResult& r, const odometry::Trajectory& truth) {
  if (truth.empty() || truth.front().time > r.estimate.front().time ||
      truth.back().time < r.estimate.back().time)
    return {};
  std::vector<odometry::Twist> errors;
  const odometry::Pose first = InterpolateAt(truth, r.estimate.front().time);
  const odometry::Pose first_found = r.estimate.front().pose;
  for (const odometry::StampedPose& estimate : r.estimate) {
    const odometry::Pose way = first.Inverse() * InterpolateAt(truth, estimate.time);
    const odometry::Pose found = first_found.Inverse() * estimate.pose;
    const Eigen::Quaterniond turn = found.rotation * way.rotation.conjugate();
    odometry::Twist error;
    error << found.position - way.position,
        odometry::Log({turn, Eigen::Vector3d::Zero()}).tail<3>();
    errors.push_back(error);
  }
  return errors;
}

std::optional<Calibration> Calibrate(const std::vector<odometry::Twist>& errors,
                                     const std::vector<odometry::Matrix6>& covariance,
                                     Eigen::Index first) {
  if (errors.size() < 2) return std::nullopt;
  Calibration c;
  double error_squares = 0;
  double variances = 0;
  for (std::size_t i = 1; i < errors.size(); ++i) {
    const double error = errors[i].segment<3>(first).norm();
    const double variance = covariance[i].diagonal().segment<3>(first).sum();
    const double deviation = std::sqrt(variance);
    c.mean += deviation;
    c.within_1_sigma += error <= deviation ? 1 : 0;
    c.within_3_sigma += error <= 3 * deviation ? 1 : 0;
    error_squares += error * error;
    variances += variance;
  }
  const auto count = static_cast<double>(errors.size() - 1);
  c.mean /= count;
  c.within_1_sigma /= count;
  c.within_3_sigma /= count;
  c.width = error_squares > 0 ? std::sqrt(variances / error_squares) : 0;
  return c;
}

odometry::TimedPoints PointsOf(const Scan& scan, const CodingLoss& loss) {
  odometry::TimedPoints timed;
  if (scan.organised()) {
    timed = OrganisedPoints(scan, loss.range_step_m);
  } else {
    for (std::size_t i = 0; i + 2 < scan.xyz.size(); i += 3)
      timed.points.push_back(Eigen::Map<const Eigen::Vector3f>(&scan.xyz[i]).cast<double>());
    timed.rings = scan.rings;
    timed.phases = scan.phases;
  }
  if (loss.xyz_bits > 0) QuantizeCube(loss.xyz_bits, &timed.points);
  return timed;
}

SlamResult RunSlam(ScanStream* scans, const SlamOptions& options,
                   const std::function<void(std::size_t)>& progress) {
  SlamResult result;
  odometry::Odometry odometry(options.odometry);
  slam::LoopSettings loop_settings;
  loop_settings.most_maps = options.most_local_maps;
  slam::LoopCloser closer(loop_settings);
  const auto imu = MakeImu(*scans, options);
  PointErrors errors;
  const bool lossy = options.loss.range_step_m > 0 || options.loss.xyz_bits > 0;
  for (std::size_t done = 0; options.max_scans == 0 || done < options.max_scans; ++done) {
    const auto timed = scans->Next();
    if (!timed) break;
    const odometry::TimedPoints points = PointsOf(timed->scan, options.loss);
    if (lossy) errors.Add(PointsOf(timed->scan, {}).points, points.points);
    if (imu)
      for (const ImuSample& s : imu->Until((timed->start + timed->duration).time_since_epoch()))
        odometry.OnTurn(s.time, Eigen::Map<const Eigen::Vector3d>(s.angular_velocity.data()),
                        Eigen::Map<const Eigen::Vector3d>(s.acceleration.data()));
    const std::clock_t begin = std::clock();
    const odometry::Estimate e = odometry.OnScan(timed->start, timed->duration, points);
    result.cpu_ms.push_back(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    result.estimate.push_back({e.time, e.pose});
    if (options.close_loops && e.tracking != odometry::Tracking::kLost)
      closer.AddScan(result.estimate.back(), odometry.last_scan());
    result.covariance.push_back(e.covariance);
    result.states.push_back(e.tracking);
    result.with_gyroscope += e.turn_measured ? 1U : 0U;
    if (done < kStart && e.tracking == odometry::Tracking::kLost) ++result.lost_at_start;
    if (e.map_restarted || e.tracking == odometry::Tracking::kStarted) ++result.maps;
    if (timed->truth) result.truth.push_back({e.time, TrueMiddle(*timed)});
    progress(done + 1);
  }
  result.mean_point_error_m = errors.count > 0 ? errors.sum_m / errors.count : 0;
  result.max_point_error_m = errors.max_m;
  std::sort(result.cpu_ms.begin(), result.cpu_ms.end());
  result.map_voxels = odometry.map().voxels();
  if (options.close_loops) {
    closer.Finish();
    result.closed = closer.Correct(result.estimate);
    result.closures = closer.closures().size();
    result.local_maps = closer.local_maps();
  }
  return result;
}

}  // namespace lidar::tools
