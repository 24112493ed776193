// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/slice_decoder.h"

#include <algorithm>
#include <utility>

namespace lidar::codec {

SliceDecoder::SliceDecoder(const CloudFormat& format, std::uint32_t max_points,
                           const IntegerCoder* integers)
    : layout_(format.layout),
      max_points_(max_points),
      decoder_(*format.sensor_model, integers),
      projection_(*format.sensor_model) {}

std::optional<SliceDecoder::Shape> SliceDecoder::Decode(ByteView stream) {
  ByteReader reader(stream);
  if (!decoder_.Decode(&reader, max_points_, &image_, &scale_, &store_)) return std::nullopt;
  const RangeHeader& h = decoder_.header();
  quality_ = {h.grid.step_m(), decoder_.error_m(), h.intensity.bits(),
              h.kept_beams > 0 ? static_cast<double>(h.kept_beams) / h.beams : 1};
  if (reader.remaining() > 0 && !AppendBlocks(&reader)) return std::nullopt;
  const bool is_dense =
      std::find(image_.ranges.begin(), image_.ranges.end(), 0U) == image_.ranges.end();
  return Shape{image_.columns, image_.beams, image_.first_column, is_dense};
}

/// Decodes the blocks after the first one and appends their columns to the image.
bool SliceDecoder::AppendBlocks(ByteReader* reader) {
  const std::uint32_t turn = decoder_.columns_per_scan();
  std::uint32_t columns = image_.columns;
  blocks_.clear();
  blocks_.push_back(std::move(image_));
  while (reader->remaining() > 0) {
    RangeImage block;
    IntensityScale scale;
    const std::size_t room = max_points_ - std::size_t{columns} * blocks_[0].beams;
    if (!decoder_.Decode(reader, room, &block, &scale, &store_) ||
        block.first_column != (blocks_[0].first_column + columns) % turn ||
        block.columns > turn - columns || scale.bits() != scale_.bits() ||
        scale.full() != scale_.full()) {
      return false;
    }
    columns += block.columns;
    quality_.error_m = std::max(quality_.error_m, decoder_.error_m());
    quality_.step_m = std::max(quality_.step_m, decoder_.header().grid.step_m());
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
  WriteRangeImage(image_, scale_, projection_, layout_, raw);
}

}  // namespace lidar::codec
