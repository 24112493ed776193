// SPDX-License-Identifier: LGPL-2.1-or-later
// Removes, thins and moves points of clouds.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "src/cloud/point_fields.h"
#include "src/cloud/sensor_model.h"

namespace lidar {

/// The treatment of points without a return, and of removed points.
enum class InvalidPoints {
  kKeep,    // points without a return stay as they are, removed points become zero
  kZero,    // all fields zero
  kNan,     // x, y and z are NaN, the rest zero
  kRemove,  // removed from the cloud, which loses its rows
};

/// The steps of the filter, in their order.
struct PointFilterSettings {
  std::uint32_t beam_step = 1;    // every n-th row
  std::uint32_t column_step = 1;  // every n-th column of the scan
  double min_range_m = 0;
  double max_range_m = 0;                         // 0: no limit
  bool has_pose = false;                          // clouds have a pose that moves them
  std::optional<Transform> transform;             // applied after the pose
  std::optional<std::array<double, 6>> crop_box;  // least, then largest x, y, z, transformed [m]
  bool crop_inside = false;                       // removes the inside of the box
  double voxel_size_m = 0;                        // one point in each cube is kept; 0: all
  InvalidPoints invalid = InvalidPoints::kKeep;

  bool needs_xyz() const {
    return min_range_m > 0 || max_range_m > 0 || has_pose || transform || crop_box ||
           voxel_size_m > 0 || invalid != InvalidPoints::kKeep;
  }
};

/// Parses numbers with spaces or commas between them; nothing for other text.
std::optional<std::vector<double>> ParseNumbers(const std::string& text);
/// Parses sixteen numbers, row by row, or x, y, z [m], roll, pitch, yaw [degrees]: a turn about x,
/// then y, then z, then a translation.
std::optional<Transform> ParseTransform(const std::string& text);
/// `orientation` is a unit quaternion x, y, z, w.
Transform FromPose(const std::array<double, 3>& position, const std::array<double, 4>& orientation);

/// Rows of a cloud, with their columns.
struct CloudRows {
  const std::uint8_t* points = nullptr;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t first_column = 0;  // of the scan
  Transform pose{};                // of the sensor, if the settings need it
};

struct FilteredCloud {
  std::vector<std::uint8_t> points;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t first_column = 0;
};

class PointFilter {
 public:
  /// Returns nothing if the settings need x, y and z as adjacent F32 and `fields` lack them.
  static std::optional<PointFilter> Make(const PointFilterSettings& settings,
                                         const PointFields& fields, std::uint32_t point_step);

  FilteredCloud Apply(const CloudRows& cloud);
  /// Number of returns that the filter removed.
  std::uint64_t removed() const { return removed_; }

 private:
  PointFilter(const PointFilterSettings& settings, std::uint32_t xyz, std::uint32_t point_step)
      : settings_(settings), xyz_(xyz), point_step_(point_step) {}
  void Take(const std::uint8_t* point, std::vector<std::uint8_t>* out);
  bool Keeps(std::array<float, 3>* xyz);
  bool IsFirstInVoxel(const std::array<float, 3>& xyz);

  PointFilterSettings settings_;
  std::uint32_t xyz_;  // offset of x
  std::uint32_t point_step_;
  Transform pose_{};                          // of the cloud
  std::unordered_set<std::uint64_t> voxels_;  // of the cloud
  std::uint64_t removed_ = 0;
};

}  // namespace lidar
