// SPDX-License-Identifier: LGPL-2.1-or-later
// Pushes received slices downstream, with the caps of their stream config.
#pragma once
#include <gst/rtp/gstrtpbasedepayload.h>

#include <atomic>
#include <memory>
#include <vector>

#include "src/base/allowance.h"
#include "src/rtp/receiver.h"

namespace lidar::gst {

/// The output of rtplidardepay. Only the streaming thread may use it, except for the counts.
class SliceOutput {
 public:
  explicit SliceOutput(GstRTPBaseDepayload* element) : element_(element) {}

  /// Pushes the slices. Consecutive slices with the same config are pushed as one list. Drops
  /// slices of a coder that the next element does not accept, and slices of a format that changes
  /// too often. Posts one warning for each of these cases. The first slice after dropped slices has
  /// the flag DISCONT.
  void Push(std::vector<rtp::ReceivedSlice> slices, Time now);
  /// Resets all members, including the counts. The caller must hold the lock of the element.
  void Reset();
  /// Must be called if the times that are passed to Push() start anew.
  void ResetTime() { changes_ = {kFormatChanges, kFormatChangePeriod}; }

  guint64 not_accepted() const { return not_accepted_; }
  guint64 format_changes() const { return format_changes_; }

 private:
  using Config = std::shared_ptr<const rtp::StreamConfig>;

  bool MayChangeTo(const Config& config, Time now);
  bool SetCapsOf(const rtp::StreamConfig& config);

  // A change of the format is expensive for downstream, compared to the bytes of a slice: it takes
  // caps of up to 200 kB, an event in each queue, a channel in a recording, and a NATS message.
  static constexpr int kFormatChanges = 8;
  static constexpr Duration kFormatChangePeriod = std::chrono::seconds(1);

  GstRTPBaseDepayload* element_;
  Config config_;  // config of the current caps on the src pad
  Config asked_;   // config of the caps that were offered last
  Allowance changes_{kFormatChanges, kFormatChangePeriod};
  bool discont_ = false;  // true if slices before the next slice were dropped
  bool warned_of_coder_ = false;
  bool warned_of_changes_ = false;
  std::atomic<guint64> not_accepted_{0};
  std::atomic<guint64> format_changes_{0};
};

}  // namespace lidar::gst
