// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs the odometry over all scans of a source. Before that, the loss of a codec is applied to the
// points.
#pragma once
#include <functional>

#include "src/odometry/odometry.h"
#include "src/odometry/trajectory.h"
#include "src/tools/lab/codec_lab/scan_source.h"

namespace lidar::tools {

/// The changes that a codec makes to points before they are aligned. By default, there are none.
struct CodingLoss {
  double range_step_m = 0;  // lidarenc: step of the grid on which ranges lie
  unsigned xyz_bits = 0;    // Draco as in the paper: bits of a coordinate in the cube of the scan
};

struct SlamOptions {
  odometry::OdometrySettings odometry;
  CodingLoss loss;
  std::size_t max_scans = 0;  // 0: all
  bool gyroscope = false;     // only for sources that have the motion of the sensor
  bool close_loops = false;
  std::size_t most_local_maps = 1000;  // only with `close_loops`
};

struct SlamResult {
  odometry::Trajectory estimate;
  odometry::Trajectory truth;                 // empty if the source has no truth
  std::vector<odometry::Matrix6> covariance;  // covariance of each estimate
  std::vector<odometry::Tracking> states;
  std::size_t with_gyroscope = 0;
  std::size_t lost_at_start = 0;  // number of lost scans among the first twenty
  std::vector<double> cpu_ms;     // CPU time of each scan, in ascending order
  std::size_t map_voxels = 0;     // number of voxels in the map at the end
  std::size_t maps = 0;
  // The mean and the largest distance by which the loss has moved points.
  double mean_point_error_m = 0;
  double max_point_error_m = 0;
  // The following members are set with `close_loops`.
  odometry::Trajectory closed;  // the estimate without the drift between loops
  std::size_t closures = 0;
  std::size_t local_maps = 0;
};

/// Runs the odometry. Calls `progress` with the number of scans that are done.
SlamResult RunSlam(ScanStream* scans, const SlamOptions& options,
                   const std::function<void(std::size_t)>& progress);

/// Returns the errors of the motion since the first pose, along the axes of that pose: x, y and z
/// [m], and turns [rad]. Returns an empty list if `truth` does not cover the time of the estimate.
std::vector<odometry::Twist> ErrorsOf(const SlamResult& result, const odometry::Trajectory& truth);

/// The relation between the errors of an odometry and its deviations.
struct Calibration {
  double mean = 0;  // mean of the deviations [m or rad]
  double within_1_sigma = 0;
  double within_3_sigma = 0;
  double width = 0;  // root mean square of the deviations, divided by that of the errors
};
/// Calibrates positions if `first` is 0, and turns if it is 3. Returns nothing if there are fewer
/// than two errors.
std::optional<Calibration> Calibrate(const std::vector<odometry::Twist>& errors,
                                     const std::vector<odometry::Matrix6>& covariance,
                                     Eigen::Index first);

/// Returns the true pose of the sensor in the middle of a scan. The scan must have a `truth`.
odometry::Pose TrueMiddle(const TimedScan& scan);

/// Returns the points of a scan after `loss`, and their phases in the sweep if these are known.
odometry::TimedPoints PointsOf(const Scan& scan, const CodingLoss& loss);

}  // namespace lidar::tools
