// SPDX-License-Identifier: LGPL-2.1-or-later
// The part of a coded cloud that beams see: an image of ranges, and what the image lacks.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/codec/cloud/beam_table.h"
#include "src/codec/cloud/firing_order.h"
#include "src/codec/cloud/pixel_list.h"
#include "src/codec/cloud_io.h"
#include "src/codec/intensity_scale.h"
#include "src/codec/range_codec.h"
#include "src/codec/range_header.h"

namespace lidar::codec::cloud {

/// Levels of the points of a list, at full resolution; null: geometry only.
struct PointLevels {
  const std::vector<std::uint8_t>* levels = nullptr;
  IntensityScale scale;  // scale of the coded levels
};

/// How the ranges are coded.
struct RangeWay {
  RangeCoder coder = RangeCoder::kBlended;
  unsigned effort = 1;  // of kMixing
};

/// Keeps its buffers between sections.
class BeamSectionEncoder {
 public:
  /// Appends the section. Returns false if the range coder refuses the image.
  bool Encode(BeamTable table, const PixelErrors& errors, const PointLevels& levels,
              const RangeWay& way, PixelList* list, std::vector<std::uint8_t>* out);

 private:
  RangeEncoder* CoderOf(const BeamTable& table);

  std::unique_ptr<RangeEncoder> coder_;  // of rows_ and columns_
  std::uint32_t rows_ = 0;
  std::uint32_t columns_ = 0;
};

/// Keeps its buffers between sections.
class BeamSectionDecoder {
 public:
  /// Appends the points of the next section of `reader`: beam by beam, in the order of columns, the
  /// returns of a pixel side by side. Sets `places` if it is not null. Returns false, with `cloud`
  /// and `places` undefined, if the section is damaged or has more than `max_points`.
  bool Decode(ByteReader* reader, std::size_t max_points, const IntensityScale& scale,
              XyzCloud* cloud, PointPlaces* places = nullptr);

 private:
  std::unique_ptr<RangeDecoder> decoder_;
  std::uint32_t rows_ = 0;  // of decoder_
  std::uint32_t columns_ = 0;
};

}  // namespace lidar::codec::cloud
