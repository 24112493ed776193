// SPDX-License-Identifier: LGPL-2.1-or-later
// The points that a moving sensor has seen, in a common frame, and the route of the sensor.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "gst/lidar/gstlidar.h"

namespace lidar::gst {

/// A transform of points from the frame of the sensor to the frame of the poses.
struct Rigid {
  std::array<float, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major
  std::array<float, 3> position{};

  std::array<float, 3> operator()(float x, float y, float z) const {
    const auto& r = rotation;
    return {r[0] * x + r[1] * y + r[2] * z + position[0],
            r[3] * x + r[4] * y + r[5] * z + position[1],
            r[6] * x + r[7] * y + r[8] * z + position[2]};
  }
  float heading() const;  // [rad]
};

/// A map with one point per cube, in bounded memory. If there are too many points, the cubes become
/// larger. If the route has too many places, every second place is removed.
class TrailMap {
 public:
  struct Point {
    std::array<float, 3> at;
    float value;  // the value that determines the colour
    std::uint16_t last_scan = 0;
    std::uint16_t scans = 0;  // number of scans that saw the point
  };

  explicit TrailMap(std::size_t most_points = kMostPoints);

  /// Sets the pose of the sensor at the time `seconds`. The velocity is computed from the previous
  /// pose.
  void MoveTo(const GstLidarPose& pose, double seconds);
  /// Returns the predicted pose of the sensor at the time `later_s` after the last pose.
  Rigid PoseAfter(double later_s) const;

  /// Ends a scan, to which all points since the last call belong.
  void EndScan() { ++scan_; }
  void Add(const std::array<float, 3>& at, float value);

  const std::vector<Point>& points() const { return points_; }
  /// Returns the places of the sensor's route, in their order.
  const std::vector<std::array<float, 3>>& way() const { return way_; }
  float cube_m() const { return cube_m_; }

  static constexpr std::size_t kMostPoints = std::size_t{1} << 20;
  static constexpr std::size_t kMostPlaces = 16384;

 private:
  std::size_t SlotOf(const std::array<float, 3>& at) const;
  void Coarsen();
  void NotePlace();

  std::size_t most_points_;
  float cube_m_ = 0.2F;
  std::vector<Point> points_;
  std::vector<std::uint32_t> slots_;  // index of a point plus 1; 0: free
  std::uint16_t scan_ = 1;
  std::vector<std::array<float, 3>> way_;
  float place_step_m_ = 0.5F;
  GstLidarPose pose_{};
  GstLidarPose before_{};
  double pose_s_ = 0;
  double step_s_ = 0;  // time between the last two poses; 0: unknown velocity
  std::uint64_t poses_ = 0;
};

}  // namespace lidar::gst
