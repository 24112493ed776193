// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks the clouds that an encoder receives, and finds their place in the stream.
#pragma once
#include <optional>

#include "gst/common/buffer_map.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidarencoder.h"
#include "src/cloud/range_check.h"
#include "src/rate/rate_loop.h"

namespace lidar::gst {

/// The input of an encoder. Only the streaming thread may use it. Posts problems of clouds as
/// messages of the encoder.
class CloudInput {
 public:
  /// If `codes_ranges` is true, only ranges are encoded, so Read() warns if positions contradict
  /// the ranges.
  void SetFormat(const CloudInfo& info, bool codes_ranges);
  const CloudInfo& info() const { return info_; }

  struct Place {
    GstLidarSlice slice{};
    rate::SlicePlace in_stream;
    bool starts_scan = false;
  };
  /// Returns the place of the next buffer. A buffer without a meta counts as a scan with one slice.
  Place PlaceOf(GstBuffer* buffer);
  /// Makes the next slice start a scan. Must be called after a flush.
  void ForgetScan() { scan_id_.reset(); }

  /// Returns the slice in a buffer. If the buffer does not match its caps, posts an error message
  /// and returns nothing.
  std::optional<GstLidarRawSlice> Read(GstLidarEncoder* encoder, const BufferMap& map,
                                       const GstLidarSlice& slice);
  /// Warns, once, that a cloud was skipped. `extent_m` is the longest side of its box.
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
