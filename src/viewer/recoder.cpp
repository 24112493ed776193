// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/viewer/recoder.h"

#include <algorithm>

namespace lidar::viewer {
namespace {

constexpr double kCoarsest = 16;
constexpr double kChange = 1.05;  // largest change of the grid from slice to slice
constexpr double kWeight = 0.2;   // weight of a slice in the averages

}  // namespace

std::optional<Recoder> Recoder::Create(const codec::CloudFormat& format) {
  auto encoder = codec::SliceEncoder::Create(format);
  if (!encoder) return std::nullopt;
  return Recoder(*std::move(encoder));
}

bool Recoder::Encode(const Decoded& slice, std::vector<std::uint8_t>* out) {
  constexpr double kAnyError_m = 100;
  encoder_.Load(slice.points, slice.shape.first_column, slice.quality.intensity_bits > 0);
  codec::SliceSettings settings;
  settings.max_error_m = kAnyError_m;
  settings.step_m = slice.quality.step_m * coarseness_;
  settings.intensity_bits = slice.quality.intensity_bits;
  codec::EncodedSlice encoded;
  if (encoder_.Encode(settings, &encoded) != codec::SliceResult::kEncoded) return false;
  *out = std::move(encoded.bytes);
  Adapt(slice.coded_size, out->size());
  return true;
}

void Recoder::Adapt(std::size_t coded, std::size_t recoded) {
  coded_ += kWeight * (static_cast<double>(coded) - coded_);
  recoded_ += kWeight * (static_cast<double>(recoded) - recoded_);
  if (recoded_ > coded_) coarseness_ *= kChange;
  if (recoded_ * kChange < coded_) coarseness_ /= kChange;
  coarseness_ = std::clamp(coarseness_, 1.0, kCoarsest);
}

}  // namespace lidar::viewer
