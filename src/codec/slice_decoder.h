// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes the slices of one stream; any bytes give a cloud or nothing.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/cloud/range_projection.h"
#include "src/codec/slice_encoder.h"

namespace lidar::codec {

/// For one thread at a time.
class SliceDecoder {
 public:
  /// `geometry` is not kAuto; kRange needs a sensor model.
  SliceDecoder(const CloudFormat& format, Geometry geometry, std::uint32_t max_points);

  struct Shape {
    std::uint32_t width = 0;
    std::uint32_t height = 1;
    std::uint32_t first_column = 0;
    bool is_dense = true;  // no point is missing
  };
  /// Decodes a slice and keeps it for Write(). None for a stream that is damaged, of another
  /// sensor, or larger than max_points.
  std::optional<Shape> Decode(ByteView stream);
  /// What the slice says of itself; an xyz slice, which is a plain Draco file, nothing.
  struct Quality {
    double step_m = 0;
    double error_m = 0;  // bound that holds with this step
    unsigned intensity_bits = 0;
    double keep_fraction = 1;  // of the beams; the others were left out to save bits
  };
  /// Of the slice decoded last, in range geometry.
  const Quality& quality() const { return quality_; }
  /// Writes width * height points of the format.
  void Write(std::uint8_t* raw) const;

 private:
  std::optional<Shape> DecodeRange(ByteView stream);

  CloudLayout layout_;
  std::uint32_t max_points_;
  std::optional<RangeDecoder> range_decoder_;
  std::optional<RangeProjection> projection_;
  bool AppendBlocks(ByteReader* reader);

  RangeImage image_;
  std::vector<RangeImage> blocks_;
  IntensityScale scale_;
  Quality quality_;
  XyzCloud cloud_;
};

}  // namespace lidar::codec
