// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs an odometry over all scans of a source. A codec's loss is applied to the points first.
#pragma once
#include <functional>

#include "src/odometry/odometry.h"
#include "src/odometry/trajectory.h"
#include "src/tools/lab/codec_lab/scan_source.h"

namespace lidar::tools {

/// Changes of the points before they are aligned; by default none.
struct CodingLoss {
  double range_step_m = 0;  // lidarenc: ranges on a grid of this step
  unsigned xyz_bits = 0;    // Draco as in the paper: bits over the cube of the scan
};

struct SlamOptions {
  odometry::OdometrySettings odometry;
  CodingLoss loss;
  std::size_t max_scans = 0;  // 0: all
  bool gyroscope = false;     // only for sources whose true pose is known at any time
  bool close_loops = false;
  std::size_t most_local_maps = 1000;  // with close_loops
};

struct SlamResult {
  odometry::Trajectory estimate;
  odometry::Trajectory truth;                 // empty if the source has no truth
  std::vector<odometry::Matrix6> covariance;  // covariance of each estimate
  std::vector<odometry::Tracking> states;
  std::size_t with_gyroscope = 0;
  std::size_t lost_at_start = 0;  // of the first twenty scans
  std::vector<double> cpu_ms;     // of each scan, ascending
  std::size_t map_voxels = 0;     // at the end
  std::size_t maps = 0;
  // Mean and largest distance by which the loss moved points.
  double mean_point_error_m = 0;
  double max_point_error_m = 0;
  // Set with close_loops
  odometry::Trajectory closed;  // the estimate without the drift between loops
  std::size_t closures = 0;
  std::size_t local_maps = 0;
};

/// Calls progress() with the number of scans done.
SlamResult RunSlam(ScanStream* scans, const SlamOptions& options,
                   const std::function<void(std::size_t)>& progress);

/// Errors of the motion since the first pose, along the axes of that pose: x, y, z [m], and turns
/// [rad]. Empty if `truth` does not cover the estimate.
std::vector<odometry::Twist> ErrorsOf(const SlamResult& result, const odometry::Trajectory& truth);

/// Errors relative to the odometry's deviations.
struct Calibration {
  double mean = 0;  // of the deviations [m or rad]
  double within_1_sigma = 0;
  double within_3_sigma = 0;
  double width = 0;  // deviations divided by errors, both root mean squares
};
/// `first`: 0 for positions, 3 for turns. Returns nothing for fewer than two errors.
std::optional<Calibration> Calibrate(const std::vector<odometry::Twist>& errors,
                                     const std::vector<odometry::Matrix6>& covariance,
                                     Eigen::Index first);

/// The pose of the sensor in the middle of a scan, for scans with a known truth.
odometry::Pose TrueMiddle(const TimedScan& scan);

/// Returns the returns of a scan after `loss`, with their phases in the sweep if known.
odometry::TimedPoints PointsOf(const Scan& scan, const CodingLoss& loss);

}  // namespace lidar::tools
