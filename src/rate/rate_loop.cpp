// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/rate_loop.h"

#include <algorithm>

namespace lidar::rate {
namespace {

ControllerParameters ParametersFor(const LoopSettings& settings, const LoadedSlice& loaded,
                                   const StepRange& steps) {
  ControllerParameters p;
  p.limits.finest_step_m = steps.finest_step_m;
  p.limits.coarsest_step_m = std::max(steps.coarsest_step_m, steps.finest_step_m);
  p.limits.step_unit_m = steps.step_unit_m;
  p.limits.level = loaded.level;
  p.limits.intensity_bits = loaded.has_intensity ? settings.intensity_bits : 0;
  if (settings.fixed_step_m > 0) {
    p.limits.coarsest_step_m = std::min(p.limits.coarsest_step_m, settings.fixed_step_m);
    p.limits.finest_step_m = p.limits.coarsest_step_m;
  }
  p.degradation = settings.degradation;
  return p;
}

SliceFeatures FeaturesOf(const SlicePlace& place, const LoadedSlice& loaded) {
  SliceFeatures features;
  features.scan_id = place.scan_id;
  features.slice_index = place.slice_index;
  features.slice_count = place.slice_count;
  features.scans_per_second = place.scans_per_second;
  features.returns = static_cast<std::uint32_t>(loaded.returns);
  features.extent_m = loaded.extent_m;
  features.mode = loaded.mode;
  return features;
}

}  // namespace

LoopResult RateLoop::Encode(const SlicePlace& place, const LoopSettings& settings,
                            std::optional<DataRate> target, SliceCoder* coder) {
  const LoadedSlice loaded = coder->loaded();
  controller_.SetParameters(ParametersFor(settings, loaded, coder->Steps(settings.max_error_m)));
  controller_.SetTarget(settings.fixed_step_m > 0 ? std::nullopt : target);
  const Decision decision = controller_.NextSlice(FeaturesOf(place, loaded));
  LoopResult result;
  result.mode = loaded.mode;
  result.skipped = decision.skip;
  result.keep_fraction = decision.keep_fraction;
  result.max_error_m = settings.max_error_m;
  if (decision.skip) return result;
  if (decision.keep_fraction < 1 && loaded.rows > 0)
    coder->Thin(ThinningPattern(loaded.rows, decision.keep_fraction));
  for (std::optional<Settings> next = decision.settings; next;) {
    result.intensity_bits = next->intensity_bits;
    result.result = coder->Encode(settings.max_error_m, *next, &result.slice);
    if (result.result != CodingResult::kEncoded || result.slice.returns == 0) break;
    EncodedSize encoded;
    encoded.size = DataSize::Bytes(static_cast<std::int64_t>(result.slice.bytes));
    encoded.step_m = result.slice.step_m;
    encoded.keep_fraction = decision.keep_fraction;
    next = controller_.OnEncoded(encoded);
  }
  return result;
}

}  // namespace lidar::rate
