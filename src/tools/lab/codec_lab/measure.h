// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures the size and the error of a whole source at one setting.
#pragma once
#include <optional>

#include "src/tools/lab/codec_lab/slice_codec.h"

namespace lidar::tools {

struct Measurement {
  double step_m = 0;  // mean over the slices, each of which may have its own step
  double quantization_bits = 0;
  double bits_per_return = 0;
  double bitrate = 0;  // bit/s
  Distortion errors;
};

/// A setting of the codec. It is given by a step or, as in the paper, by the number of bits of a
/// coordinate in the slice's bounding cube.
struct MeasuredSetting {
  double step_m = 0;
  unsigned quantization_bits = 0;  // if not 0, replaces the step
  unsigned intensity_bits = 0;
  std::uint32_t slices = 1;
};

/// Encodes all scans of a source. Returns nothing if the codec refuses the setting.
std::optional<Measurement> Measure(const ScanSet& set, const CodingMode& mode,
                                   const MeasuredSetting& setting);

/// Returns the mode of our coder at `effort`. The default in the lab is effort 0
/// (DefaultRangeMode).
const CodingMode& ModeOfEffort(unsigned effort);
const CodingMode& DefaultRangeMode();
/// Returns the default mode of dracoenc. It has range geometry if the source is organised, and
/// otherwise xyz geometry.
const CodingMode& DefaultMode(const ScanSet& set);

}  // namespace lidar::tools
