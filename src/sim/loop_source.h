// SPDX-License-Identifier: LGPL-2.1-or-later
// A simulated encoder: the real rate controller, with slices whose sizes are computed by a formula.
#pragma once
#include <cstdint>
#include <optional>

#include "src/rate/rate_controller.h"
#include "src/sim/simulation.h"
#include "src/sim/synthetic_codec.h"

namespace lidar::loop {

struct SourceOptions {
  std::uint32_t slices = 8;  // per scan; 1: whole scans
  double scans_per_second = 10;
  double max_error_m = 0.05;
  unsigned intensity_bits = 0;
  double bits_per_return = 7.1;  // at a step of 1 cm; the lowest rate is then 1.4 Mbit/s
  rate::DegradationPreference degradation = rate::DegradationPreference::kMaintainAccuracy;
  bool adapts = true;  // false: always uses the coarsest step
  unsigned seed = 1;
};

/// Encodes slices for a target bitrate as dracoenc does. Sizes and bounds are those on the wire.
class LoopSource {
 public:
  explicit LoopSource(const SourceOptions& options);

  scream::test::EncodedFrame Next(DataRate target);
  DataRate min() const { return Wire(controller_.bounds().min); }
  DataRate max() const { return Wire(controller_.bounds().max); }
  const rate::ControllerStats& stats() const { return controller_.stats(); }

 private:
  static DataRate Wire(DataRate media) { return media / kPayloadShare; }
  static constexpr double kPayloadShare = 0.96;  // the remainder is headers

  rate::EncodedSize Encode(const rate::SliceFeatures& features, const rate::Decision& decision);

  SourceOptions options_;
  rate::SyntheticCodec codec_;
  rate::RateController controller_;
  std::uint32_t scan_ = 0;
  std::uint32_t slice_ = 0;
};

}  // namespace lidar::loop
