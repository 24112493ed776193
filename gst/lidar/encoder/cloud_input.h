// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks the clouds that come to an encoder, and finds their place in the stream.
#pragma once
#include <optional>

#include "gst/common/buffer_map.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidarencoder.h"
#include "src/cloud/range_check.h"
#include "src/rate/rate_loop.h"

namespace lidar::gst {

/// Belongs to the streaming thread. Posts faults of clouds as messages of the encoder.
class CloudInput {
 public:
  /// `codes_ranges`: ranges alone are coded, so positions that contradict them give a warning.
  void SetFormat(const CloudInfo& info, bool codes_ranges);
  const CloudInfo& info() const { return info_; }

  struct Place {
    GstLidarSlice slice{};
    rate::SlicePlace in_stream;
    bool starts_scan = false;
  };
  /// The place of the next buffer. A buffer without a meta is a scan of one slice.
  Place PlaceOf(GstBuffer* buffer);
  /// Call it after a flush: the next slice starts a scan.
  void ForgetScan() { scan_id_.reset(); }

  /// Returns nothing after an error message if the buffer does not hold the cloud of its caps.
  std::optional<GstLidarRawSlice> Read(GstLidarEncoder* encoder, const BufferMap& map,
                                       const GstLidarSlice& slice);
  /// Warns, once, that a cloud was left out. `extent_m` is the length of its box.
  void WarnOfReach(GstLidarEncoder* encoder, double extent_m);

 private:
  void CheckRanges(GstLidarEncoder* encoder, ByteView raw, guint first_column);

  CloudInfo info_;
  std::optional<RangeCheck> range_check_;
  std::optional<guint> scan_id_;  // scan of the last slice
  guint scans_without_meta_ = 0;
  bool warned_of_reach_ = false;
  bool warned_of_ranges_ = false;
};

}  // namespace lidar::gst
