// SPDX-License-Identifier: LGPL-2.1-or-later
// The slice encoder as the rate loop sees a coder.
#pragma once
#include "ext/draco/slice_coder.h"
#include "src/rate/error_bound.h"
#include "src/rate/slice_coder.h"

namespace lidar::gst {

class EncCoder : public rate::SliceCoder {
 public:
  EncCoder(draco::SliceEncoder* encoder, unsigned level, codec::EncodedSlice* slice)
      : encoder_(encoder), level_(level), slice_(slice) {}

  rate::LoadedSlice loaded() const override {
    return {encoder_->returns(),
            encoder_->extent_m(),
            encoder_->rows(),
            encoder_->has_intensity(),
            level_,
            encoder_->Mode(level_)};
  }
  rate::StepRange Steps(double max_error_m) const override {
    const auto bound = encoder_->geometry() == Geometry::kRange
                           ? rate::ErrorBound::Range(encoder_->range_unit_mm())
                           : rate::ErrorBound::Xyz();
    return {bound.FinestStep(), bound.CoarsestStep(max_error_m), bound.step_unit()};
  }
  void Thin(const std::vector<bool>& kept) override { encoder_->Thin(kept); }
  rate::CodingResult Encode(double max_error_m, const rate::Settings& settings,
                            rate::CodedSlice* slice) override {
    const auto result = encoder_->Encode(
        {{max_error_m, settings.step_m, settings.intensity_bits}, settings.level}, slice_);
    *slice = {slice_->bytes.size(), slice_->returns, slice_->step_m, slice_->error_m};
    return static_cast<rate::CodingResult>(result);
  }

 private:
  draco::SliceEncoder* encoder_;
  unsigned level_;
  codec::EncodedSlice* slice_;
};

}  // namespace lidar::gst
