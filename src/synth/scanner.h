// SPDX-License-Identifier: LGPL-2.1-or-later
// Simulates a LiDAR on a car that drives through a synthetic scene.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "src/base/time.h"
#include "src/synth/rays.h"
#include "src/synth/scene.h"
#include "src/synth/sector_index.h"
#include "src/synth/sensors.h"

namespace lidar::synth {

struct ScannerConfig {
  Sensor sensor;
  Duration period = std::chrono::milliseconds(100);  // duration of one turn
  SceneKind scene = SceneKind::kStreet;
  double speed_mps = 0;
  double roughness = 1;   // factor of the motion that the scene's road gives the car
  double noise_m = 0.01;  // standard deviation of a range on a white wall nearby
  std::uint64_t seed = 0;
  bool second_returns = false;  // two echoes if a beam meets two surfaces; needs a second ray
  bool mixed_pixels = false;    // beams that meet an edge give ranges between two surfaces
};

/// The measured returns, beam by beam: the index is [beam * columns + column]. If a range is 0,
/// there is no return.
struct Returns {
  std::vector<std::uint32_t> range_mm;
  // The reflectivity on Ouster's scale: percent, and above 100 for retroreflectors.
  std::vector<std::uint8_t> reflectivity;
  std::vector<std::uint16_t> signal;  // strength of the echo (photons), in an arbitrary unit
  // The weaker echo of each pixel. These lists are empty without `second_returns`.
  std::vector<std::uint32_t> range2_mm;
  std::vector<std::uint8_t> reflectivity2;
  std::vector<std::uint16_t> signal2;
};

/// Casts the rays of a sensor. The rays of a column start at the column's time, from the position
/// that the sensor has at that time. Returns depend only on configuration, scan and pixel, and not
/// on how calls divide a scan. Only one thread at a time may use it.
class Scanner {
 public:
  explicit Scanner(const ScannerConfig& config);

  /// Casts the columns of `window` in turn number `scan`. The window must lie within the turn.
  void Cast(std::uint64_t scan, ColumnWindow window, Returns* returns);
  /// Returns the time from the start of the drive to the sampling of `column` in turn `scan`.
  Duration ColumnTime(std::uint64_t scan, std::uint32_t column) const;
  const Rays& rays() const { return rays_; }
  const Trajectory& trajectory() const { return trajectory_; }

 private:
  struct Column {
    std::uint32_t index;
    Vec3 origin;        // origin of its rays, relative to the anchor
    Rotation rotation;  // sensor to world
    float age_s;        // time since the chunk began
    std::uint64_t key;  // key of its noise
  };
  struct Pixel {
    std::uint32_t range_mm = 0;
    std::uint8_t reflectivity = 0;
    std::uint16_t signal = 0;
  };

  void MoveAnchor(double x, double y);
  void BeginChunk(std::uint64_t scan, std::uint32_t chunk);
  Column MakeColumn(std::uint64_t scan, std::uint32_t column) const;
  SectorIndex::Arc ArcOf(std::uint64_t scan, std::uint32_t first, std::uint32_t last) const;
  Hit Trace(const Ray& ray, float age_s, Random* noise) const;
  Pixel Measure(const Hit& hit, Random* noise) const;
  std::vector<Hit> TraceColumn(std::uint64_t scan, std::uint32_t column);
  Hit MixWith(const Hit& beside, Hit hit, Random* noise) const;
  struct Echoes {
    Pixel strongest;
    Pixel second;
  };
  Echoes MeasureBoth(const Column& column, Vec3 direction, const Hit& center, Random* noise) const;

  ScannerConfig config_;
  Rays rays_;
  float reach_m_;
  float signal_scale_;
  std::vector<float> gauss_;
  std::unique_ptr<Scene> scene_;
  Trajectory trajectory_;

  // The part of the world around the sensor, and the shapes in it. Fixed shapes come first.
  View view_;
  std::size_t static_shapes_ = 0;
  std::vector<Shape> shapes_;
  // A chunk is a part of the sweep. The shapes are sorted by distance once per chunk.
  std::uint32_t chunk_columns_;
  Duration chunk_time_{};
  SectorIndex index_;
};

}  // namespace lidar::synth
