// SPDX-License-Identifier: LGPL-2.1-or-later
// Trains the start states of the mixing coder, and measures how much they save.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "src/codec/mixing/slice_coder.h"
#include "src/codec/mixing/start_states.h"
#include "src/tools/lab/codec_lab/scan.h"

namespace lidar::tools {

/// A setting of the mixing coder.
struct MixingCase {
  unsigned effort = 2;
  double error_m = 0.02;
  unsigned level_bits = 0;
  std::uint32_t slices = 8;  // number of slices per scan
};

/// Returns states that are trained on all scans of `sets`. They are rounded as in the table.
std::unique_ptr<codec::mixing::StartStates> TrainMixing(const std::vector<const ScanSet*>& sets);

/// Returns the bits per return of the encoded blocks, including their headers. Decodes each block,
/// and throws std::runtime_error if the result differs from the input.
double BitsPerReturn(const ScanSet& set, const MixingCase& setting,
                     const codec::mixing::StartStates& states);

}  // namespace lidar::tools
