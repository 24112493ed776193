// SPDX-License-Identifier: LGPL-2.1-or-later
// Detects whether a sensor stands still. If it does, slices should refer to earlier slices.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "src/codec/block_memory.h"
#include "src/codec/range_image.h"

namespace lidar::codec {

/// Returns true if `memory` predicts the pixels of `image` better than their left neighbours do, on
/// a grid of `step_m`.
bool Resembles(const RangeImage& image, const BlockMemory& memory, double step_m);

/// Compares each slice with the previous slice of the same sector.
class Standstill {
 public:
  /// Returns true if `image` resembles the previous image that began in the same column.
  bool OnImage(const RangeImage& image, double step_m);

 private:
  static constexpr std::size_t kMostSectors = 256;
  static constexpr std::size_t kMostPixels = 4U << 20;        // 16 MiB
  std::map<std::uint32_t, std::vector<std::uint32_t>> last_;  // last ranges, by first column
};

}  // namespace lidar::codec
