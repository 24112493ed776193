// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures the errors of the points that an encoder encodes, and posts them.
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
  double max_error_m = 0;  // the limit that the user has set
  double bound_m = 0;      // the largest error that the step of the grid allows
  bool thinned = false;    // the encoder removed some beams
};

/// Decodes every n-th slice again, and posts the measured errors as lidar-error-check. If several
/// slices in a row exceed max_error_m, warns only of the first. Only the streaming thread may use
/// it.
class ErrorReport {
 public:
  struct Outcome {
    PointErrors errors;
    bool holds = false;
  };

  explicit ErrorReport(GstLidarEncoder* encoder);
  /// Compares the points in `raw`, whose layout is `info`, with the points in `coded`. Does this
  /// only for every `every`-th slice (0: never), and returns nothing for all other slices.
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
