// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/rate_loop.h"

#include <algorithm>

#include "src/rate/residual_model.h"

namespace lidar::gst {
namespace {

rate::ControllerParameters ParametersFor(const LoopSettings& settings,
                                         const codec::SliceEncoder& encoder) {
  const auto residual = encoder.geometry() == codec::Geometry::kRange
                            ? rate::ResidualModel::Range(encoder.range_unit_mm())
                            : rate::ResidualModel::Xyz();
  rate::ControllerParameters p;
  p.limits.finest_step_m = residual.FinestStep();
  p.limits.coarsest_step_m =
      std::max(residual.CoarsestStep(settings.max_error_m), p.limits.finest_step_m);
  p.limits.step_unit_m = residual.step_unit();
  p.limits.level = settings.level;
  p.limits.intensity_bits = encoder.has_intensity() ? settings.intensity_bits : 0;
  if (settings.fixed_step_m > 0) {
    p.limits.coarsest_step_m = std::min(p.limits.coarsest_step_m, settings.fixed_step_m);
    p.limits.finest_step_m = p.limits.coarsest_step_m;
  }
  p.degradation = settings.degradation;
  return p;
}

}  // namespace

LoopResult RateLoop::Encode(const SlicePlace& place, const LoopSettings& settings,
                            std::optional<DataRate> target, codec::SliceEncoder* encoder,
                            codec::EncodedSlice* slice) {
  controller_.SetParameters(ParametersFor(settings, *encoder));
  controller_.SetTarget(settings.fixed_step_m > 0 ? std::nullopt : target);
  rate::SliceFeatures features;
  features.scan_id = place.scan_id;
  features.slice_index = place.slice_index;
  features.slice_count = place.slice_count;
  features.scans_per_second = place.scans_per_second;
  features.returns = static_cast<std::uint32_t>(encoder->returns());
  features.extent_m = encoder->extent_m();
  features.mode = encoder->Mode(settings.level);
  const rate::Decision decision = controller_.NextSlice(features);
  LoopResult result;
  result.skipped = decision.skip;
  result.keep_fraction = decision.keep_fraction;
  result.max_error_m = settings.max_error_m;
  if (decision.skip) return result;
  if (decision.keep_fraction < 1 && encoder->rows() > 0)
    encoder->Thin(rate::ThinningPattern(encoder->rows(), decision.keep_fraction));
  for (std::optional<rate::Settings> next = decision.settings; next;) {
    result.intensity_bits = next->intensity_bits;
    result.result = encoder->Encode(
        {settings.max_error_m, next->step_m, next->intensity_bits, next->level}, slice);
    if (result.result != codec::SliceResult::kEncoded || slice->returns == 0) break;
    rate::EncodedSlice encoded;
    encoded.size = DataSize::Bytes(static_cast<std::int64_t>(slice->bytes.size()));
    encoded.step_m = slice->step_m;
    encoded.keep_fraction = decision.keep_fraction;
    next = controller_.OnEncoded(encoded);
  }
  return result;
}

}  // namespace lidar::gst
