// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages of dracoenc about the point errors that it measured.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <vector>

#include "ext/draco/enc_error_check.h"
#include "src/codec/slice_encoder.h"

namespace lidar::gst {

struct CheckedSlice {
  guint scan_id = 0;
  guint slice_index = 0;
  double max_error_m = 0;  // what was asked for
  double bound_m = 0;      // what the step of the grid promises
  bool thinned = false;    // points were left out on purpose
};

/// Decodes every n-th slice again, and posts its real errors as dracoenc-error-check. A warning
/// tells of the first of several that break max_error_m.
class ErrorReport {
 public:
  struct Outcome {
    PointErrors errors;
    bool holds = false;
  };

  ErrorReport(const codec::CloudFormat& format, Geometry geometry) : check_(format, geometry) {}
  /// `input` became `bytes`. None where this slice is not one of every `every` (0: of none).
  std::optional<Outcome> OnSlice(GstElement* element, guint every, GstBuffer* input,
                                 const std::vector<std::uint8_t>& bytes, const CheckedSlice& slice);

 private:
  ErrorCheck check_;
  guint left_out_ = 0;  // slices until the next check
  bool warned_ = false;
};

}  // namespace lidar::gst
