// SPDX-License-Identifier: LGPL-2.1-or-later
// The interface of a coder for the rate loop. A coder encodes its loaded slice at a step, any
// number of times.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "src/rate/size_model.h"

namespace lidar::rate {

/// What a coder has loaded.
struct LoadedSlice {
  std::size_t returns = 0;  // points that would be coded if none were thinned
  double extent_m = 0;      // longest side of the box around the points, or the longest range
  std::size_t rows = 0;     // beams or points that Thin() chooses from; 0: thinning is impossible
  bool has_intensity = false;  // the slice has intensities, and they are wanted
  unsigned level = 0;          // highest compression level; only some rate models lower it
  std::string mode;            // SliceFeatures::mode
};

/// The steps of the grids that keep within an error.
struct StepRange {
  double finest_step_m = 0.001;   // finer steps would code meaningless digits
  double coarsest_step_m = 0.04;  // no point moves farther than the requested error
  double step_unit_m = 0;         // steps are finest_step_m plus multiples of this; 0: any step
};

struct CodedSlice {
  std::size_t bytes = 0;
  std::size_t returns = 0;
  double step_m = 0;   // the step that was used
  double error_m = 0;  // largest error with this step
};

enum class CodingResult {
  kEncoded,
  kEmpty,       // there is nothing that this coder could encode
  kOutOfReach,  // no grid of this coder keeps within the error
};

/// Encodes the slices of a stream. The coder keeps the encoded bytes. The loop only gets their
/// number.
class SliceCoder {
 public:
  virtual ~SliceCoder() = default;

  virtual LoadedSlice loaded() const = 0;
  /// Returns the steps for the loaded slice. If the error is small, the coarsest step may be below
  /// the finest step.
  virtual StepRange Steps(double max_error_m) const = 0;
  /// Drops each row whose element of `kept` is false. `kept` has loaded().rows elements.
  virtual void Thin(const std::vector<bool>& kept) = 0;
  /// Encodes the loaded slice. The result replaces that of an earlier call. The coder may use
  /// another step than that of `settings`, but the error is never above `max_error_m`.
  virtual CodingResult Encode(double max_error_m, const Settings& settings, CodedSlice* slice) = 0;
};

}  // namespace lidar::rate
