// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/slice_encoder.h"

#include <algorithm>
#include <functional>
#include <system_error>
#include <thread>
#include <utility>

#include "src/codec/effort_control.h"

namespace lidar::codec {
namespace {

/// Copies the columns [first, first + sector->columns) of `image` to `sector`.
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

/// Calls task(i) for each i below `count`. Each call has its own thread, as long as the system
/// provides threads.
template <class Task>
void CallInThreads(std::uint32_t count, const Task& task) {
  std::vector<std::thread> workers;
  workers.reserve(count);
  std::uint32_t next = 1;
  try {
    for (; next < count; ++next) workers.emplace_back(std::cref(task), next);
  } catch (const std::system_error&) {
    // The remaining tasks are called in this thread.
  }
  task(0);
  for (; next < count; ++next) task(next);
  for (std::thread& worker : workers) worker.join();
}

}  // namespace

std::optional<SliceEncoder> SliceEncoder::Create(const CloudFormat& format, RangeCoder coder,
                                                 const IntegerCoder* integers) {
  if (!format.HasRanges()) return std::nullopt;
  return SliceEncoder(format, coder, integers);
}

SliceEncoder::SliceEncoder(const CloudFormat& format, RangeCoder coder,
                           const IntegerCoder* integers)
    : format_(format),
      coder_(coder),
      effort_(coder == RangeCoder::kMixing ? 1 : 0),
      integers_(integers) {}

void SliceEncoder::set_effort(unsigned effort) {
  if (coder_ != RangeCoder::kAdaptive && coder_ != RangeCoder::kMixing) return;
  effort_ = std::min(effort, EffortControl::kHighest);
  coder_ = effort_ > 0 ? RangeCoder::kMixing : RangeCoder::kAdaptive;
}

std::string SliceEncoder::Mode() const {
  switch (coder_) {
    case RangeCoder::kDraco:
      return "range-draco";
    case RangeCoder::kResidual:
      return "range-residual";
    case RangeCoder::kMixing:
      return (refers_ ? "range-temporal" : "range-mixing") + std::to_string(effort_);
    case RangeCoder::kTemporal:
    case RangeCoder::kBlended:
    case RangeCoder::kAdaptive:
      break;
  }
  return "range-adaptive";
}

void SliceEncoder::Load(ByteView raw, std::uint32_t first_column, bool with_intensity) {
  has_intensity_ = with_intensity && HasIntensity(format_.layout.fields);
  kept_beams_ = 0;
  keeper_ = nullptr;
  refers_ = false;
  image_.beams = format_.height;
  image_.columns =
      static_cast<std::uint32_t>(raw.size / format_.layout.point_step / format_.height);
  image_.first_column = first_column % format_.sensor_model->columns_per_scan;
  full_scale_ = ReadRangeImage(raw, format_.layout, has_intensity_, &image_);
  const auto& ranges = image_.ranges;
  returns_ = ranges.size() - static_cast<std::size_t>(std::count(ranges.begin(), ranges.end(), 0U));
  extent_m_ = ranges.empty() ? 0 : 1e-3 * *std::max_element(ranges.begin(), ranges.end());
  unit_mm_ = CommonUnit(ranges, format_.sensor_model->range_unit_mm);
}

void SliceEncoder::LinkBy(const ReferenceKeeper* keeper) {
  keeper_ = nullptr;
  refers_ = false;
  if (keeper == nullptr || coder_ != RangeCoder::kMixing) return;
  const bool stands = standstill_.OnImage(image_, last_step_m_);
  if (!stands) return;
  keeper_ = keeper;
  refers_ = keeper->HasReference();
}

void SliceEncoder::Thin(const std::vector<bool>& kept) {
  const auto count = static_cast<std::uint32_t>(std::count(kept.begin(), kept.end(), true));
  if (count < image_.beams) kept_beams_ = count;
  for (std::uint32_t beam = 0; beam < image_.beams; ++beam) {
    const auto row = image_.ranges.begin() + beam * std::ptrdiff_t{image_.columns};
    if (kept[beam]) continue;
    returns_ -=
        image_.columns - static_cast<std::size_t>(std::count(row, row + image_.columns, 0U));
    std::fill_n(row, image_.columns, 0);
  }
}

RangeGrid SliceEncoder::GridFor(const SliceSettings& settings) const {
  const auto coarsest = RangeGrid::ForError(settings.max_error_m, unit_mm_);
  if (settings.step_m <= 0) return coarsest;
  const auto asked = RangeGrid::ForStep(settings.step_m, unit_mm_);
  return asked.parts() < coarsest.parts() ? asked : coarsest;
}

SliceResult SliceEncoder::Encode(const SliceSettings& settings, EncodedSlice* slice) {
  slice->bytes.clear();
  RangeSettings range;
  range.coder = coder_;
  range.effort = effort_;
  range.intensity =
      IntensityScale(full_scale_, image_.intensity.empty() ? 0 : settings.intensity_bits);
  range.kept_beams = kept_beams_;
  range.grid = GridFor(settings);
  const std::size_t most = std::min<std::size_t>(returns_ / kMinBlockReturns, image_.columns);
  const auto blocks = static_cast<std::uint32_t>(std::min<std::size_t>(threads_, most));
  slice->blocks.clear();
  if (!EncodeBlocks(range, std::max(blocks, 1U), slice)) return SliceResult::kEmpty;
  last_step_m_ = range.grid.step_m();
  slice->returns = returns_;
  slice->step_m = range.grid.step_m();
  slice->error_m = range.grid.error_m();
  return SliceResult::kEncoded;
}

bool SliceEncoder::EncodeBlock(const RangeImage& image, const RangeSettings& settings,
                               RangeEncoder* encoder, BlockLink* link,
                               std::vector<std::uint8_t>* out) const {
  out->clear();
  if (keeper_ == nullptr) return encoder->Encode(image, settings, out);
  link->reference = refers_ ? keeper_->Reference(image) : nullptr;
  if (link->reference && !Resembles(image, *link->reference, last_step_m_)) link->reference.reset();
  return encoder->Encode(image, settings, out, link);
}

bool SliceEncoder::EncodeBlocks(const RangeSettings& settings, std::uint32_t count,
                                EncodedSlice* slice) {
  while (blocks_.size() < count) blocks_.emplace_back(*format_.sensor_model, integers_);
  const auto encode = [&](std::uint32_t i) {
    Block& block = blocks_[i];
    if (count == 1) {
      block.encoded = EncodeBlock(image_, settings, &block.encoder, &block.link, &block.bytes);
      return;
    }
    const std::uint32_t first = image_.columns * i / count;
    block.image.columns = image_.columns * (i + 1) / count - first;
    block.image.first_column =
        (image_.first_column + first) % format_.sensor_model->columns_per_scan;
    CopySector(image_, first, &block.image);
    block.encoded = EncodeBlock(block.image, settings, &block.encoder, &block.link, &block.bytes);
  };
  CallInThreads(count, encode);
  for (std::uint32_t i = 0; i < count; ++i) {
    Block& block = blocks_[i];
    if (!block.encoded) {
      slice->blocks.clear();
      for (Block& each : blocks_) each.link = {};
      return false;
    }
    slice->bytes.insert(slice->bytes.end(), block.bytes.begin(), block.bytes.end());
    if (block.link.left != nullptr) slice->blocks.push_back(std::move(block.link.left));
    block.link = {};
  }
  return true;
}

}  // namespace lidar::codec
