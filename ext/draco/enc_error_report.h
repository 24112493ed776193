// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages of dracoenc about the point errors that it measured.
#pragma once
#include <gst/gst.h>

#include <optional>

#include "draco/enc_error_check.h"

namespace lidar::gst {

struct CheckedSlice {
  guint scan_id = 0;
  guint slice_index = 0;
  double max_error_m = 0;  // what was asked for
  double bound_m = 0;      // what the step of the grid promises
  bool thinned = false;    // points were left out on purpose
};

/// Posts `errors` (none: the slice cannot be decoded) as dracoenc-error-check. Where they break
/// max_error_m the result is false, and with `warn` a warning tells as well.
bool PostErrors(GstElement* element, const CheckedSlice& slice,
                const std::optional<PointErrors>& errors, bool warn);

}  // namespace lidar::gst
