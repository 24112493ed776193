// SPDX-License-Identifier: LGPL-2.1-or-later
#include "draco/codec/range_codec.h"

#include <algorithm>
#include <array>

namespace lidar::codec {
namespace {

// So that sums and differences of bins fit an int32.
constexpr std::uint32_t kMaxRangeMm = AdaptiveCoder::kMaxBins - 1;

}  // namespace

bool RangeEncoder::Encode(const RangeImage& image, const RangeSettings& settings,
                          std::vector<std::uint8_t>* out) {
  const bool with_levels = settings.intensity.bits() > 0;
  lists_.values.clear();  // for returns()
  if (image.beams != alignment_.beams() || image.columns == 0 ||
      image.columns > alignment_.columns_per_scan() ||
      image.first_column >= alignment_.columns_per_scan() || image.ranges.size() != image.size() ||
      (with_levels && image.intensity.size() != image.size())) {
    return false;
  }
  CollectReturns(image, settings);
  EncodeMask(image.columns);
  if (!EncodePayload(settings, image.columns)) return false;
  RangeHeader header;
  header.coder = settings.coder;
  header.beams = image.beams;
  header.first_column = image.first_column;
  header.columns = image.columns;
  header.grid = settings.grid;
  header.intensity = settings.intensity;
  header.mask_size = static_cast<std::uint32_t>(mask_bytes_.size());
  header.payload_size = static_cast<std::uint32_t>(payload_.size());
  header.Write(out);
  out->insert(out->end(), mask_bytes_.begin(), mask_bytes_.end());
  out->insert(out->end(), payload_.begin(), payload_.end());
  return true;
}

void RangeEncoder::CollectReturns(const RangeImage& image, const RangeSettings& settings) {
  mask_.resize(image.size());
  lists_.values.resize(image.size());
  // BinOf(), exact below 2^28: half a part keeps the quotient from the next integer, by more than
  // it is rounded.
  const RangeGrid& grid = settings.grid;
  const double per_mm = RangeGrid::kParts / (1.0 * grid.parts() * grid.unit_mm());
  const double half_part = 0.5 / grid.parts();
  std::size_t count = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint32_t range = std::min(image.ranges[i], kMaxRangeMm);
    mask_[i] = range != 0 ? 1 : 0;
    lists_.values[count] =
        static_cast<std::int32_t>(static_cast<std::int32_t>(range) * per_mm + half_part);
    count += mask_[i];
  }
  lists_.values.resize(count);
  lists_.levels.resize(settings.intensity.bits() > 0 ? count : 0);
  if (lists_.levels.empty()) return;
  std::array<std::uint8_t, 256> coarse{};
  for (unsigned i = 0; i < coarse.size(); ++i)
    coarse[i] = settings.intensity.Coarsen(static_cast<std::uint8_t>(i));
  std::size_t next = 0;
  for (std::size_t i = 0; i < image.size(); ++i)
    if (mask_[i] != 0) lists_.levels[next++] = coarse[image.intensity[i]];
}

/// No bytes at all stand for a mask without a gap.
void RangeEncoder::EncodeMask(std::uint32_t columns) {
  mask_bytes_.clear();
  if (returns() == mask_.size()) return;
  rans_.Start(mask_.size());
  mask_coder_.Encode(mask_, alignment_, columns, &rans_);
  rans_.Finish(&mask_bytes_);
}

bool RangeEncoder::EncodePayload(const RangeSettings& settings, std::uint32_t columns) {
  payload_.clear();
  if (returns() == 0) return true;
  const BlockShape shape{alignment_, mask_, columns};
  if (settings.coder == RangeCoder::kAdaptive) {
    // A residual is two symbols at most.
    rans_.Start(2 * (lists_.values.size() + lists_.levels.size()));
    coder_.Encode(shape, lists_, &rans_);
    rans_.Finish(&payload_);
    return true;
  }
  if (settings.coder == RangeCoder::kResidual) coder_.ToResiduals(shape, &lists_);
  return EncodeIntegers(lists_, settings.coder == RangeCoder::kDraco, &payload_);
}

bool RangeDecoder::Decode(ByteReader* reader, std::size_t max_points, RangeImage* image,
                          IntensityScale* scale) {
  const auto header = RangeHeader::Read(reader);
  if (!header || header->beams != alignment_.beams() ||
      header->columns > alignment_.columns_per_scan() ||
      header->first_column >= alignment_.columns_per_scan() ||
      std::size_t{header->beams} * header->columns > max_points) {
    return false;
  }
  image->beams = header->beams;
  image->columns = header->columns;
  image->first_column = header->first_column;
  *scale = header->intensity;
  const ByteView mask = reader->Bytes(header->mask_size);
  const ByteView payload = reader->Bytes(header->payload_size);
  mask_.assign(image->size(), 1);
  if (!DecodeMask(mask, header->columns) || !DecodePayload(*header, payload)) return false;
  image->intensity.assign(header->intensity.bits() > 0 ? image->size() : 0, 0);
  return Scatter(header->grid, image);
}

bool RangeDecoder::DecodeMask(ByteView bytes, std::uint32_t columns) {
  if (bytes.empty()) return true;
  RansDecoder rans(bytes);
  mask_coder_.Decode(alignment_, columns, &rans, &mask_);
  return rans.AtEnd();
}

bool RangeDecoder::DecodePayload(const RangeHeader& header, ByteView bytes) {
  const auto returns = static_cast<std::size_t>(std::count(mask_.begin(), mask_.end(), 1));
  const bool has_levels = header.intensity.bits() > 0;
  lists_.values.resize(returns);
  lists_.levels.resize(has_levels ? returns : 0);
  if (returns == 0) return bytes.empty();
  const BlockShape shape{alignment_, mask_, header.columns};
  if (header.coder == RangeCoder::kAdaptive) {
    RansDecoder rans(bytes);
    return coder_.Decode(shape, has_levels, &rans, &lists_) && rans.AtEnd();
  }
  if (!DecodeIntegers(bytes, static_cast<std::uint32_t>(returns), has_levels, &lists_))
    return false;
  return header.coder == RangeCoder::kDraco || coder_.FromResiduals(shape, &lists_);
}

bool RangeDecoder::Scatter(const RangeGrid& grid, RangeImage* image) const {
  const std::uint32_t last_bin = grid.BinOf(kMaxRangeMm);
  image->ranges.assign(image->size(), 0);
  std::size_t next = 0;
  for (std::size_t i = 0; i < image->size(); ++i) {
    if (mask_[i] == 0) continue;
    const auto bin = static_cast<std::uint32_t>(lists_.values[next]);
    if (bin > last_bin) return false;
    image->ranges[i] = grid.RangeOf(bin);
    if (!image->intensity.empty()) image->intensity[i] = lists_.levels[next];
    ++next;
  }
  return true;
}

}  // namespace lidar::codec
