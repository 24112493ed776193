// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/slice_decoder.h"

#include <algorithm>
#include <utility>

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
  if (!range_decoder_->Decode(&reader, max_points_, &image_, &scale_)) return std::nullopt;
  const RangeHeader& h = range_decoder_->header();
  quality_ = {h.grid.step_m(), h.grid.error_m(), h.intensity.bits(),
              h.kept_beams > 0 ? static_cast<double>(h.kept_beams) / h.beams : 1};
  if (reader.remaining() > 0 && !AppendBlocks(&reader)) return std::nullopt;
  const bool is_dense =
      std::find(image_.ranges.begin(), image_.ranges.end(), 0U) == image_.ranges.end();
  return Shape{image_.columns, image_.beams, image_.first_column, is_dense};
}

/// Decodes the blocks behind the first one and puts them to its right.
bool SliceDecoder::AppendBlocks(ByteReader* reader) {
  const std::uint32_t turn = range_decoder_->columns_per_scan();
  std::uint32_t columns = image_.columns;
  blocks_.clear();
  blocks_.push_back(std::move(image_));
  while (reader->remaining() > 0) {
    RangeImage block;
    IntensityScale scale;
    const std::size_t room = max_points_ - std::size_t{columns} * blocks_[0].beams;
    if (!range_decoder_->Decode(reader, room, &block, &scale) ||
        block.first_column != (blocks_[0].first_column + columns) % turn ||
        block.columns > turn - columns || scale.bits() != scale_.bits() ||
        scale.full() != scale_.full()) {
      return false;
    }
    columns += block.columns;
    blocks_.push_back(std::move(block));
  }
  image_ = {blocks_[0].beams, columns, blocks_[0].first_column, {}, {}};
  for (std::uint32_t beam = 0; beam < image_.beams; ++beam) {
    for (const RangeImage& block : blocks_) {
      const auto row = static_cast<std::ptrdiff_t>(std::size_t{beam} * block.columns);
      const auto ranges = block.ranges.begin() + row;
      image_.ranges.insert(image_.ranges.end(), ranges, ranges + block.columns);
      if (block.intensity.empty()) continue;
      const auto levels = block.intensity.begin() + row;
      image_.intensity.insert(image_.intensity.end(), levels, levels + block.columns);
    }
  }
  return true;
}

void SliceDecoder::Write(std::uint8_t* raw) const {
  if (range_decoder_) {
    WriteRangeImage(image_, scale_, *projection_, layout_, raw);
  } else {
    WriteXyz(cloud_, layout_, raw);
  }
}

}  // namespace lidar::codec
