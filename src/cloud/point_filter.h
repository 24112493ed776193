// SPDX-License-Identifier: LGPL-2.1-or-later
// Removes, thins out and moves the points of clouds.
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

/// The values that replace points without a return, and points that the filter removes.
enum class InvalidPoints {
  kKeep,    // points without a return are kept; removed points become zero
  kZero,    // all fields zero
  kNan,     // x, y and z are NaN, all other fields zero
  kRemove,  // not in the cloud, which then has no rows
};

/// The settings of the filter, in the order in which they are applied.
struct PointFilterSettings {
  std::uint32_t beam_step = 1;    // keep every n-th row
  std::uint32_t column_step = 1;  // keep every n-th column of the scan
  double min_range_m = 0;
  double max_range_m = 0;              // 0 for no limit
  bool has_pose = false;               // clouds are moved by their pose
  std::optional<Transform> transform;  // applied after the pose
  // The least x, y and z, then the largest [m]. It is applied after the transform.
  std::optional<std::array<double, 6>> crop_box;
  bool crop_inside = false;  // remove the points inside the box
  double voxel_size_m = 0;   // keep one point per cube [m]; 0: keep all
  InvalidPoints invalid = InvalidPoints::kKeep;

  bool needs_xyz() const {
    return min_range_m > 0 || max_range_m > 0 || has_pose || transform || crop_box ||
           voxel_size_m > 0 || invalid != InvalidPoints::kKeep;
  }
};

/// Parses numbers that are separated by spaces or commas. Returns nothing for other text.
std::optional<std::vector<double>> ParseNumbers(const std::string& text);
/// Parses a transform. The text is sixteen numbers, row by row, or x, y, z [m], roll, pitch and yaw
/// [degrees]. Six numbers mean a rotation about x, then about y, then about z, and then a
/// translation.
std::optional<Transform> ParseTransform(const std::string& text);
/// Converts a pose to a transform. `orientation` is a unit quaternion x, y, z, w.
Transform FromPose(const std::array<double, 3>& position, const std::array<double, 4>& orientation);

/// The input of the filter: a cloud with its rows and columns.
struct CloudRows {
  const std::uint8_t* points = nullptr;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t first_column = 0;  // index of the first column in the scan
  Transform pose{};                // pose of the sensor, if the settings use it
};

struct FilteredCloud {
  std::vector<std::uint8_t> points;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t first_column = 0;
};

class PointFilter {
 public:
  /// Returns nothing if the settings need x, y and z as adjacent F32, but `fields` does not have
  /// them.
  static std::optional<PointFilter> Make(const PointFilterSettings& settings,
                                         const PointFields& fields, std::uint32_t point_step);

  FilteredCloud Apply(const CloudRows& cloud);
  /// Returns the number of returns that the filter has removed.
  std::uint64_t removed() const { return removed_; }

 private:
  PointFilter(const PointFilterSettings& settings, std::uint32_t xyz, std::uint32_t point_step)
      : settings_(settings), xyz_(xyz), point_step_(point_step) {}
  void Take(const std::uint8_t* point, std::vector<std::uint8_t>* out);
  bool Keeps(std::array<float, 3>* xyz);
  bool IsFirstInVoxel(const std::array<float, 3>& xyz);

  PointFilterSettings settings_;
  std::uint32_t xyz_;  // offset of x in a point
  std::uint32_t point_step_;
  Transform pose_{};                          // pose of the current cloud
  std::unordered_set<std::uint64_t> voxels_;  // occupied cubes of the current cloud
  std::uint64_t removed_ = 0;
};

}  // namespace lidar
