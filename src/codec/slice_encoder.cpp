// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/slice_encoder.h"

#include <algorithm>
#include <functional>
#include <system_error>
#include <thread>
#include <utility>

namespace lidar::codec {
namespace {

constexpr unsigned kTryBothEvery = 64;  // slices

/// Columns [first, first + sector->columns) of `image`.
void CopySector(const RangeImage& image, std::uint32_t first, RangeImage* sector) {
  sector->beams = image.beams;
  sector->ranges.resize(sector->size());
  sector->intensity.resize(image.intensity.empty() ? 0 : sector->size());
  for (std::size_t beam = 0; beam < image.beams; ++beam) {
    const std::size_t from = beam * image.columns + first;
    const std::size_t to = beam * sector->columns;
    std::copy_n(&image.ranges[from], sector->columns, &sector->ranges[to]);
    if (image.intensity.empty()) continue;
    std::copy_n(&image.intensity[from], sector->columns, &sector->intensity[to]);
  }
}

/// Calls task(0 .. count - 1), each in a thread of its own, as long as the system has any to give.
template <class Task>
void CallInThreads(std::uint32_t count, const Task& task) {
  std::vector<std::thread> workers;
  workers.reserve(count);
  std::uint32_t next = 1;
  try {
    for (; next < count; ++next) workers.emplace_back(std::cref(task), next);
  } catch (const std::system_error&) {
    // The rest is for this thread.
  }
  task(0);
  for (; next < count; ++next) task(next);
  for (std::thread& worker : workers) worker.join();
}

}  // namespace

std::optional<SliceEncoder> SliceEncoder::Create(const CloudFormat& format, Geometry geometry,
                                                 RangeCoder coder) {
  const PointFields& fields = format.layout.fields;
  const bool can_range = format.sensor_model &&
                         format.sensor_model->beams.size() == format.height &&
                         fields.Has("range", FieldType::kU32);
  if (geometry == Geometry::kAuto) geometry = can_range ? Geometry::kRange : Geometry::kXyz;
  if (geometry == Geometry::kRange ? !can_range : !fields.HasPackedXyz()) return std::nullopt;
  SliceEncoder encoder;
  encoder.format_ = format;
  encoder.coder_ = coder;
  if (geometry == Geometry::kRange) encoder.range_encoder_.emplace(*format.sensor_model);
  return encoder;
}

std::string SliceEncoder::Mode(unsigned level) const {
  // Draco's kd-tree has four modes, whatever the level is called.
  if (!range_encoder_)
    return level == 0 ? "xyz-sequential" : "xyz-kd" + std::to_string(std::min(level / 2 * 2, 6U));
  switch (coder_) {
    case RangeCoder::kDraco:
      return "range-draco";
    case RangeCoder::kResidual:
      return "range-residual";
    case RangeCoder::kAdaptive:
      break;
  }
  return "range-adaptive";
}

void SliceEncoder::Load(ByteView raw, std::uint32_t first_column, bool with_intensity) {
  has_intensity_ = with_intensity && HasIntensity(format_.layout.fields);
  if (!range_encoder_) {
    ReadXyz(raw, format_.layout, has_intensity_, &cloud_);
    returns_ = cloud_.size();
    extent_m_ = LongestSide(cloud_);
    return;
  }
  kept_beams_ = 0;
  image_.beams = format_.height;
  image_.columns =
      static_cast<std::uint32_t>(raw.size / format_.layout.point_step / format_.height);
  image_.first_column = first_column % format_.sensor_model->columns_per_scan;
  full_scale_ = ReadRangeImage(raw, format_.layout, has_intensity_, &image_);
  const auto& ranges = image_.ranges;
  returns_ = ranges.size() - static_cast<std::size_t>(std::count(ranges.begin(), ranges.end(), 0U));
  extent_m_ = ranges.empty() ? 0 : 1e-3 * *std::max_element(ranges.begin(), ranges.end());
  // A cloud that was filtered or moved may have ranges between the sensor's own.
  unit_mm_ = format_.sensor_model->range_unit_mm;
  if (!AreMultiples(ranges, unit_mm_)) unit_mm_ = 1;
}

void SliceEncoder::Thin(const std::vector<bool>& kept) {
  if (range_encoder_) {
    const auto count = static_cast<std::uint32_t>(std::count(kept.begin(), kept.end(), true));
    if (count < image_.beams) kept_beams_ = count;
    for (std::uint32_t beam = 0; beam < image_.beams; ++beam) {
      const auto row = image_.ranges.begin() + beam * std::ptrdiff_t{image_.columns};
      if (kept[beam]) continue;
      returns_ -=
          image_.columns - static_cast<std::size_t>(std::count(row, row + image_.columns, 0U));
      std::fill_n(row, image_.columns, 0);
    }
    return;
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (!kept[i]) continue;
    std::copy_n(&cloud_.xyz[3 * i], 3, &cloud_.xyz[3 * count]);
    if (!cloud_.intensity.empty()) cloud_.intensity[count] = cloud_.intensity[i];
    ++count;
  }
  returns_ = count;
  cloud_.xyz.resize(3 * count);
  if (!cloud_.intensity.empty()) cloud_.intensity.resize(count);
}

SliceResult SliceEncoder::Encode(const SliceSettings& settings, EncodedSlice* slice) {
  slice->bytes.clear();
  return range_encoder_ ? EncodeRange(settings, slice) : EncodeXyz(settings, slice);
}

SliceResult SliceEncoder::EncodeRange(const SliceSettings& settings, EncodedSlice* slice) {
  RangeSettings range;
  range.coder = coder_;
  range.intensity =
      IntensityScale(full_scale_, image_.intensity.empty() ? 0 : settings.intensity_bits);
  range.kept_beams = kept_beams_;
  range.grid = RangeGrid::ForError(settings.max_error_m, unit_mm_);
  if (settings.step_m > 0) {
    const auto asked = RangeGrid::ForStep(settings.step_m, unit_mm_);
    if (asked.parts() < range.grid.parts()) range.grid = asked;
  }
  const std::size_t most = std::min<std::size_t>(returns_ / kMinBlockReturns, image_.columns);
  const auto blocks = static_cast<std::uint32_t>(std::min<std::size_t>(threads_, most));
  const bool encoded = blocks > 1 ? EncodeBlocks(range, blocks, &slice->bytes)
                                  : range_encoder_->Encode(image_, range, &slice->bytes);
  if (!encoded) return SliceResult::kEmpty;
  slice->returns = returns_;
  slice->step_m = range.grid.step_m();
  slice->error_m = range.grid.error_m();
  return SliceResult::kEncoded;
}

bool SliceEncoder::EncodeBlocks(const RangeSettings& settings, std::uint32_t count,
                                std::vector<std::uint8_t>* out) {
  while (blocks_.size() < count) blocks_.emplace_back(*format_.sensor_model);
  const auto encode = [&](std::uint32_t i) {
    Block& block = blocks_[i];
    const std::uint32_t first = image_.columns * i / count;
    block.image.columns = image_.columns * (i + 1) / count - first;
    block.image.first_column =
        (image_.first_column + first) % format_.sensor_model->columns_per_scan;
    CopySector(image_, first, &block.image);
    block.bytes.clear();
    block.encoder.Encode(block.image, settings, &block.bytes);
  };
  CallInThreads(count, encode);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (blocks_[i].bytes.empty()) return false;
    out->insert(out->end(), blocks_[i].bytes.begin(), blocks_[i].bytes.end());
  }
  return true;
}

/// Which of Draco's coders is smaller depends on the order of the points: that of a sensor suits
/// the sequential one.
bool SliceEncoder::TryBothMethods(const XyzSettings& settings, EncodedSlice* slice,
                                  XyzResult* result) {
  XyzSettings other = settings;
  other.method = XyzMethod::kSequential;
  std::vector<std::uint8_t> sequential;
  if (!codec::EncodeXyz(cloud_, settings, &slice->bytes, result) ||
      !codec::EncodeXyz(cloud_, other, &sequential, result)) {
    return false;
  }
  const bool smaller = sequential.size() < slice->bytes.size();
  xyz_method_ = smaller ? XyzMethod::kSequential : XyzMethod::kKdTree;
  if (smaller) slice->bytes = std::move(sequential);
  return true;
}

SliceResult SliceEncoder::EncodeXyz(const SliceSettings& settings, EncodedSlice* slice) {
  if (cloud_.size() == 0) return SliceResult::kEmpty;
  XyzSettings xyz;
  xyz.max_error_m = settings.max_error_m;
  xyz.step_m = settings.step_m;
  xyz.level = static_cast<int>(settings.level);
  xyz.method = settings.level == 0 ? XyzMethod::kSequential : xyz_method_;
  xyz.intensity_bits = settings.intensity_bits;
  XyzResult result;
  const bool try_both = settings.level > 0 && xyz_slices_++ % kTryBothEvery == 0;
  if (try_both) xyz.method = XyzMethod::kKdTree;
  if (try_both ? !TryBothMethods(xyz, slice, &result)
               : !codec::EncodeXyz(cloud_, xyz, &slice->bytes, &result)) {
    return SliceResult::kOutOfReach;
  }
  slice->returns = cloud_.size();
  slice->step_m = result.step_m;
  slice->error_m = result.error_m;
  return SliceResult::kEncoded;
}

}  // namespace lidar::codec
