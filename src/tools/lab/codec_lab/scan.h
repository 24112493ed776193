// SPDX-License-Identifier: LGPL-2.1-or-later
// A scan of any source in memory, and its slices.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "src/cloud/range_projection.h"
#include "src/cloud/sensor_model.h"

namespace lidar::tools {

/// The beams of a sensor, and the projection that converts ranges to points.
struct ScanGeometry {
  explicit ScanGeometry(SensorModel m) : model(std::move(m)), projection(model) {}
  SensorModel model;
  RangeProjection projection;
};

struct Scan {
  std::shared_ptr<const ScanGeometry> geometry;  // null: the cloud is not organised
  std::vector<std::uint32_t> ranges;             // [mm], beam by beam; only with `geometry`
  std::vector<float> xyz;                        // [m]; only without `geometry`
  std::vector<float> intensity;                  // of each range or point; may be empty
  std::vector<std::uint16_t> rings;              // beam of each point; only without `geometry`
  std::vector<float> phases;  // time of each point in the scan, 0 to 1; may be empty
  bool organised() const { return geometry != nullptr; }
};

/// Consecutive scans of a capture, of a folder of files, or of a synthetic drive.
struct ScanSet {
  std::string name;
  double scans_per_second = 10;
  std::vector<Scan> scans;
  bool organised() const { return !scans.empty() && scans.front().organised(); }
};

struct SliceOf {
  std::uint32_t index = 0;
  std::uint32_t count = 1;
};

/// Returns the columns of a slice. `count` must divide the number of columns in a scan.
ColumnWindow WindowOf(const Scan& scan, SliceOf slice);

}  // namespace lidar::tools
