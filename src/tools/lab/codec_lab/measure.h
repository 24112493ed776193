// SPDX-License-Identifier: LGPL-2.1-or-later
// Size and error of whole sources at one setting.
#pragma once
#include <optional>

#include "src/tools/lab/codec_lab/slice_codec.h"

namespace lidar::tools {

struct Measurement {
  double step_m = 0;  // mean: each slice may have its own
  double quantization_bits = 0;
  double bits_per_return = 0;
  double bitrate = 0;  // bit/s
  Distortion errors;
};

/// A setting by its step or, as in the paper, by the bits of a coordinate in the slice's bounding
/// cube.
struct MeasuredSetting {
  double step_m = 0;
  unsigned quantization_bits = 0;  // if not 0, replaces the step
  unsigned intensity_bits = 0;
  std::uint32_t slices = 1;
};

/// Returns nothing if the codec refuses the setting.
std::optional<Measurement> Measure(const ScanSet& set, const CodingMode& mode,
                                   const MeasuredSetting& setting);

/// Returns our coder at `effort`. The lab's default is effort 0 (DefaultRangeMode).
const CodingMode& ModeOfEffort(unsigned effort);
const CodingMode& DefaultRangeMode();
/// Returns dracoenc's default: range geometry for organised sources, else xyz.
const CodingMode& DefaultMode(const ScanSet& set);

}  // namespace lidar::tools
