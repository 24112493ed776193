// SPDX-License-Identifier: LGPL-2.1-or-later
// Lets the rate controller choose how a coder encodes each slice.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "src/rate/rate_controller.h"
#include "src/rate/slice_coder.h"

namespace lidar::rate {

struct LoopSettings {
  double max_error_m = 0.02;
  double fixed_step_m = 0;  // above 0: use this step for any target
  unsigned intensity_bits = 5;
  DegradationPreference degradation = DegradationPreference::kMaintainAccuracy;
};

/// Position of a slice in the stream.
struct SlicePlace {
  std::uint32_t scan_id = 0;
  std::uint32_t slice_index = 0;
  std::uint32_t slice_count = 1;
  double scans_per_second = 10;
};

struct LoopResult {
  bool skipped = false;  // the controller left the slice out to save bitrate
  std::string mode;      // coding mode
  CodingResult result = CodingResult::kEmpty;
  CodedSlice slice;  // if encoded()
  unsigned intensity_bits = 0;
  double keep_fraction = 1;
  double max_error_m = 0;  // the error bound that was required

  bool encoded() const { return !skipped && result == CodingResult::kEncoded; }
};

/// Encodes slices at a target bitrate. Not thread-safe.
class RateLoop {
 public:
  explicit RateLoop(std::unique_ptr<SizeModel> model) : controller_({}, std::move(model)) {}

  /// Encodes the slice that `coder` has loaded. If its first size is far from the budget, encodes
  /// it a second time. Without a target, the quality is constant.
  LoopResult Encode(const SlicePlace& place, const LoopSettings& settings,
                    std::optional<DataRate> target, SliceCoder* coder);
  RateController& controller() { return controller_; }

 private:
  RateController controller_;
};

}  // namespace lidar::rate
