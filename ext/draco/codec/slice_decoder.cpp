// SPDX-License-Identifier: LGPL-2.1-or-later
#include "draco/codec/slice_decoder.h"

#include <algorithm>

namespace lidar::codec {

SliceDecoder::SliceDecoder(const CloudFormat& format, Geometry geometry, std::uint32_t max_points)
    : layout_(format.layout), max_points_(max_points) {
  if (geometry != Geometry::kRange) return;
  range_decoder_.emplace(*format.sensor_model);
  projection_.emplace(*format.sensor_model);
}

std::optional<SliceDecoder::Shape> SliceDecoder::Decode(ByteView stream) {
  if (range_decoder_) return DecodeRange(stream);
  if (!DecodeXyz(stream, max_points_, &cloud_)) return std::nullopt;
  return Shape{static_cast<std::uint32_t>(cloud_.size()), 1, 0, true};
}

std::optional<SliceDecoder::Shape> SliceDecoder::DecodeRange(ByteView stream) {
  ByteReader reader(stream);
  if (!range_decoder_->Decode(&reader, max_points_, &image_, &scale_) || reader.remaining() != 0)
    return std::nullopt;
  const bool is_dense =
      std::find(image_.ranges.begin(), image_.ranges.end(), 0U) == image_.ranges.end();
  return Shape{image_.columns, image_.beams, image_.first_column, is_dense};
}

void SliceDecoder::Write(std::uint8_t* raw) const {
  if (range_decoder_) {
    WriteRangeImage(image_, scale_, *projection_, layout_, raw);
  } else {
    WriteXyz(cloud_, layout_, raw);
  }
}

}  // namespace lidar::codec
