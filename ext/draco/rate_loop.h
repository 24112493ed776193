// SPDX-License-Identifier: LGPL-2.1-or-later
// Lets the rate controller choose how each slice is encoded.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "src/codec/slice_encoder.h"
#include "src/rate/rate_controller.h"

namespace lidar::gst {

struct LoopSettings {
  double max_error_m = 0.02;
  double fixed_step_m = 0;  // above 0: this step, whatever the target
  unsigned level = 7;
  unsigned intensity_bits = 5;
  rate::DegradationPreference degradation = rate::DegradationPreference::kMaintainAccuracy;
};

/// Where a slice stands in the stream.
struct SlicePlace {
  std::uint32_t scan_id = 0;
  std::uint32_t slice_index = 0;
  std::uint32_t slice_count = 1;
  double scans_per_second = 10;
};

struct LoopResult {
  bool skipped = false;  // by the controller, to save bitrate
  codec::SliceResult result = codec::SliceResult::kEmpty;
  unsigned intensity_bits = 0;
  double keep_fraction = 1;
  double max_error_m = 0;  // that was to be kept
};

/// For one thread at a time.
class RateLoop {
 public:
  explicit RateLoop(std::unique_ptr<rate::SizeModel> model) : controller_({}, std::move(model)) {}

  /// Encodes what `encoder` has loaded, twice where the first size misses the budget by much. No
  /// target: constant quality.
  LoopResult Encode(const SlicePlace& place, const LoopSettings& settings,
                    std::optional<DataRate> target, codec::SliceEncoder* encoder,
                    codec::EncodedSlice* slice);
  rate::RateController& controller() { return controller_; }

 private:
  rate::RateController controller_;
};

}  // namespace lidar::gst
