// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures the point errors of an encoder, and posts them.
#pragma once
#include <memory>
#include <optional>

#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidarencoder.h"
#include "src/base/byte_reader.h"
#include "src/cloud/point_errors.h"

namespace lidar::gst {

struct CheckedSlice {
  guint scan_id = 0;
  guint slice_index = 0;
  double max_error_m = 0;  // the user's bound
  double bound_m = 0;      // the bound that the grid's step gives
  bool thinned = false;    // the encoder left out beams
};

/// Decodes every n-th slice again, and posts its real errors as lidar-error-check. Warns of the
/// first of successive slices that exceed max_error_m. Belongs to the streaming thread.
class ErrorReport {
 public:
  struct Outcome {
    PointErrors errors;
    bool holds = false;
  };

  explicit ErrorReport(GstLidarEncoder* encoder);
  /// Compares `raw`, points as in `info`, with `coded` for every `every`-th slice (0: never).
  /// Returns nothing for the others.
  std::optional<Outcome> OnSlice(guint every, const CloudInfo& info, ByteView raw, ByteView coded,
                                 const CheckedSlice& slice);

 private:
  struct FreePoints {
    void operator()(GArray* points) const { g_array_unref(points); }
  };
  bool IsDue(guint every);
  std::optional<PointErrors> Measure(const CloudInfo& info, ByteView raw, ByteView coded,
                                     bool thinned);
  void Warn(const CheckedSlice& slice, const std::optional<PointErrors>& errors);
  void Post(const CheckedSlice& slice, const Outcome& outcome);

  GstLidarEncoder* encoder_;
  std::unique_ptr<GArray, FreePoints> points_;
  guint left_out_ = 0;  // slices until the next check
  bool warned_ = false;
};

}  // namespace lidar::gst
