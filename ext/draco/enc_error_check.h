// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes encoded slices again and measures how far their points have moved.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "ext/draco/slice_coder.h"
#include "src/base/byte_reader.h"

namespace lidar::gst {

struct PointErrors {
  std::uint64_t points = 0;   // compared
  std::uint64_t missing = 0;  // returns of the cloud that did not come back, or the other way round
  double max_m = 0;
  double mean_m = 0;
  double rounding_m = 0;  // what the 32-bit floats of the positions may add
};

/// One stream, so one format. For one thread at a time.
class ErrorCheck {
 public:
  ErrorCheck(const codec::CloudFormat& format, Geometry geometry);

  /// The distances between the points of `raw` and those that `slice`, which was encoded from it,
  /// decodes to. Pixels are compared with themselves. So are the points of clouds in xyz geometry
  /// where Draco keeps their order; a kd-tree does not, and distances are those to the nearest
  /// point, in both directions. None where the slice cannot be decoded.
  std::optional<PointErrors> Measure(ByteView raw, const std::vector<std::uint8_t>& slice);

 private:
  PointErrors ComparePixels(ByteView raw) const;
  PointErrors CompareClouds(ByteView raw, bool in_order) const;

  codec::CloudFormat input_;
  Geometry geometry_;
  std::vector<std::uint8_t> decoded_;
};

}  // namespace lidar::gst
