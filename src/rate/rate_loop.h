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
  bool skipped = false;  // the controller left it out to save bitrate
  std::string mode;      // of coding
  CodingResult result = CodingResult::kEmpty;
  CodedSlice slice;  // if encoded()
  unsigned intensity_bits = 0;
  double keep_fraction = 1;
  double max_error_m = 0;  // error bound to be kept

  bool encoded() const { return !skipped && result == CodingResult::kEncoded; }
};

/// For one thread at a time.
class RateLoop {
 public:
  explicit RateLoop(std::unique_ptr<SizeModel> model) : controller_({}, std::move(model)) {}

  /// Encodes the slice that `coder` has loaded, twice if the first size misses the budget by far.
  /// Without a target: constant quality.
  LoopResult Encode(const SlicePlace& place, const LoopSettings& settings,
                    std::optional<DataRate> target, SliceCoder* coder);
  RateController& controller() { return controller_; }

 private:
  RateController controller_;
};

}  // namespace lidar::rate
