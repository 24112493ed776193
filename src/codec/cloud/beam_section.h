// SPDX-License-Identifier: LGPL-2.1-or-later
// The beam section of a coded cloud: an image with the ranges of points on beams, and what such an
// image does not contain.
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

/// The intensity levels of a list's points, with full resolution. If `levels` is null, only
/// geometry is coded.
struct PointLevels {
  const std::vector<std::uint8_t>* levels = nullptr;
  IntensityScale scale;  // scale of the coded levels
};

/// How the ranges are coded.
struct RangeWay {
  RangeCoder coder = RangeCoder::kBlended;
  unsigned effort = 1;  // of kMixing
};

/// Encodes beam sections. Keeps its buffers between sections.
class BeamSectionEncoder {
 public:
  /// Encodes `list` as a section and appends it to `out`. Returns false if the range coder refuses
  /// the image.
  bool Encode(BeamTable table, const PixelErrors& errors, const PointLevels& levels,
              const RangeWay& way, PixelList* list, std::vector<std::uint8_t>* out);

 private:
  RangeEncoder* CoderOf(const BeamTable& table);

  std::unique_ptr<RangeEncoder> coder_;  // for rows_ and columns_
  std::uint32_t rows_ = 0;
  std::uint32_t columns_ = 0;
};

/// Decodes beam sections. Keeps its buffers between sections.
class BeamSectionDecoder {
 public:
  /// Decodes the next section of `reader` and appends its points to `cloud`. The points come beam
  /// by beam, in the order of columns. The returns of a pixel follow one another. If `places` is
  /// not null, sets it to the pixels of the points.
  ///
  /// Returns false if the section is damaged or has more than `max_points` points. `cloud` and
  /// `places` are then undefined.
  bool Decode(ByteReader* reader, std::size_t max_points, const IntensityScale& scale,
              XyzCloud* cloud, PointPlaces* places = nullptr);

 private:
  std::unique_ptr<RangeDecoder> decoder_;
  std::uint32_t rows_ = 0;  // of decoder_
  std::uint32_t columns_ = 0;
};

}  // namespace lidar::codec::cloud
