// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes the slices of one stream in range geometry; any bytes give a cloud or nothing.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/cloud/range_projection.h"
#include "src/codec/cloud_io.h"
#include "src/codec/range_codec.h"

namespace lidar::codec {

/// For one thread at a time.
class SliceDecoder {
 public:
  /// `format` must have a sensor model. `integers` must outlive the decoder; if it is null, slices
  /// of external coders are refused.
  SliceDecoder(const CloudFormat& format, std::uint32_t max_points,
               const IntegerCoder* integers = nullptr);

  struct Shape {
    std::uint32_t width = 0;
    std::uint32_t height = 1;
    std::uint32_t first_column = 0;
    bool is_dense = true;  // no point is missing
  };
  /// Decodes a slice and keeps it for Write(). Returns nothing for a stream that is damaged, of
  /// another sensor, or larger than max_points.
  std::optional<Shape> Decode(ByteView stream);
  /// True if the last Decode() failed for lack of a slice that it refers to.
  bool lacks_reference() const { return decoder_.lacks_reference(); }
  /// Lets slices refer to `block`, as if this decoder had decoded it.
  void Know(BlockMemoryPtr block) { store_.Add(std::move(block)); }
  /// Quality of a slice.
  struct Quality {
    double step_m = 0;
    double error_m = 0;  // bound of the error of all points
    unsigned intensity_bits = 0;
    double keep_fraction = 1;  // part of the beams; others were left out to save bits
  };
  /// The quality of the slice decoded last.
  const Quality& quality() const { return quality_; }
  /// Writes width * height points of the format.
  void Write(std::uint8_t* raw) const;

 private:
  bool AppendBlocks(ByteReader* reader);

  CloudLayout layout_;
  std::uint32_t max_points_;
  RangeDecoder decoder_;
  BlockStore store_;
  RangeProjection projection_;
  RangeImage image_;
  std::vector<RangeImage> blocks_;
  IntensityScale scale_;
  Quality quality_;
};

}  // namespace lidar::codec
