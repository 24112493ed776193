// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes the slices of a stream in range geometry. A slice may consist of any bytes: they give a
// cloud or an error.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/cloud/range_projection.h"
#include "src/codec/cloud_io.h"
#include "src/codec/range_codec.h"

namespace lidar::codec {

/// Not thread-safe.
class SliceDecoder {
 public:
  /// `format` must have a sensor model. `integers` must outlive the decoder. If it is null,
  /// Decode() refuses slices of external coders.
  SliceDecoder(const CloudFormat& format, std::uint32_t max_points,
               const IntegerCoder* integers = nullptr);

  struct Shape {
    std::uint32_t width = 0;
    std::uint32_t height = 1;
    std::uint32_t first_column = 0;
    bool is_dense = true;  // no point is missing
  };
  /// Decodes a slice and keeps it for Write(). Returns nothing if the slice is damaged, is of
  /// another sensor, or has more than max_points points.
  std::optional<Shape> Decode(ByteView stream);
  /// Returns true if the last Decode() failed because a slice to which it refers is missing.
  bool lacks_reference() const { return decoder_.lacks_reference(); }
  /// Adds `block` to the blocks to which slices may refer, as if this decoder had decoded it.
  void Know(BlockMemoryPtr block) { store_.Add(std::move(block)); }
  struct Quality {
    double step_m = 0;
    double error_m = 0;  // largest error of any point
    unsigned intensity_bits = 0;
    double keep_fraction = 1;  // part of the beams that the encoder did not leave out
  };
  /// Returns the quality of the slice decoded last.
  const Quality& quality() const { return quality_; }
  /// Writes the decoded slice as width * height points of the format.
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
