// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/slice_coder.h"

#include <algorithm>
#include <utility>

#include "ext/draco/draco_integers.h"

namespace lidar::draco {
namespace {

constexpr unsigned kTryBothEvery = 64;  // number of slices

}  // namespace

void XyzSliceEncoder::Load(ByteView raw, bool with_intensity) {
  has_intensity_ = with_intensity && codec::HasIntensity(layout_.fields);
  codec::ReadXyz(raw, layout_, has_intensity_, &cloud_);
}

void XyzSliceEncoder::Thin(const std::vector<bool>& kept) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (!kept[i]) continue;
    std::copy_n(&cloud_.xyz[3 * i], 3, &cloud_.xyz[3 * count]);
    if (!cloud_.intensity.empty()) cloud_.intensity[count] = cloud_.intensity[i];
    ++count;
  }
  cloud_.xyz.resize(3 * count);
  if (!cloud_.intensity.empty()) cloud_.intensity.resize(count);
}

/// Encodes with both of Draco's coders and keeps the smaller result. Which of them is smaller
/// depends on the order of the points. The sequential coder is better for points in the order of a
/// sensor.
bool XyzSliceEncoder::TryBothMethods(const XyzSettings& settings, codec::EncodedSlice* slice,
                                     XyzResult* result) {
  XyzSettings other = settings;
  other.method = XyzMethod::kSequential;
  std::vector<std::uint8_t> sequential;
  if (!EncodeXyz(cloud_, settings, &slice->bytes, result) ||
      !EncodeXyz(cloud_, other, &sequential, result)) {
    return false;
  }
  const bool smaller = sequential.size() < slice->bytes.size();
  method_ = smaller ? XyzMethod::kSequential : XyzMethod::kKdTree;
  if (smaller) slice->bytes = std::move(sequential);
  return true;
}

codec::SliceResult XyzSliceEncoder::Encode(const SliceSettings& settings,
                                           codec::EncodedSlice* slice) {
  slice->bytes.clear();
  if (cloud_.size() == 0) return codec::SliceResult::kEmpty;
  XyzSettings xyz;
  xyz.max_error_m = settings.max_error_m;
  xyz.step_m = settings.step_m;
  xyz.level = static_cast<int>(settings.level);
  xyz.method = settings.level == 0 ? XyzMethod::kSequential : method_;
  xyz.intensity_bits = settings.intensity_bits;
  XyzResult result;
  const bool try_both = settings.level > 0 && slices_++ % kTryBothEvery == 0;
  if (try_both) xyz.method = XyzMethod::kKdTree;
  if (try_both ? !TryBothMethods(xyz, slice, &result)
               : !EncodeXyz(cloud_, xyz, &slice->bytes, &result)) {
    return codec::SliceResult::kOutOfReach;
  }
  slice->returns = cloud_.size();
  slice->step_m = result.step_m;
  slice->error_m = result.error_m;
  return codec::SliceResult::kEncoded;
}

std::optional<SliceEncoder> SliceEncoder::Create(const codec::CloudFormat& format,
                                                 std::optional<Geometry> geometry,
                                                 codec::RangeCoder coder) {
  SliceEncoder encoder(format.layout);
  if (geometry != Geometry::kXyz) {
    encoder.range_ = codec::SliceEncoder::Create(format, coder, DracoIntegers::Shared());
    if (encoder.range_) return encoder;
  }
  if (geometry == Geometry::kRange || !format.layout.fields.HasPackedXyz()) return std::nullopt;
  return encoder;
}

std::string SliceEncoder::Mode(unsigned level) const {
  if (range_) return range_->Mode();
  // The kd-tree of Draco has four modes. A level without a mode of its own uses the nearest mode.
  return level == 0 ? "xyz-sequential" : "xyz-kd" + std::to_string(std::min(level / 2 * 2, 6U));
}

void SliceEncoder::Load(ByteView raw, std::uint32_t first_column, bool with_intensity) {
  if (range_) {
    range_->Load(raw, first_column, with_intensity);
  } else {
    xyz_.Load(raw, with_intensity);
  }
}

void SliceEncoder::Thin(const std::vector<bool>& kept) {
  range_ ? range_->Thin(kept) : xyz_.Thin(kept);
}

void SliceEncoder::set_threads(unsigned threads) {
  if (range_) range_->set_threads(threads);
}

void SliceEncoder::set_effort(unsigned effort) {
  if (range_) range_->set_effort(effort);
}

codec::SliceResult SliceEncoder::Encode(const SliceSettings& settings, codec::EncodedSlice* slice) {
  return range_ ? range_->Encode(settings, slice) : xyz_.Encode(settings, slice);
}

SliceDecoder::SliceDecoder(const codec::CloudFormat& format, Geometry geometry,
                           std::uint32_t max_points)
    : layout_(format.layout), max_points_(max_points) {
  if (geometry == Geometry::kRange) range_.emplace(format, max_points, DracoIntegers::Shared());
}

std::optional<SliceDecoder::Shape> SliceDecoder::Decode(ByteView stream) {
  if (range_) return range_->Decode(stream);
  if (!DecodeXyz(stream, max_points_, &cloud_)) return std::nullopt;
  return Shape{static_cast<std::uint32_t>(cloud_.size()), 1, 0, true};
}

void SliceDecoder::Write(std::uint8_t* raw) const {
  range_ ? range_->Write(raw) : codec::WriteXyz(cloud_, layout_, raw);
}

}  // namespace lidar::draco
