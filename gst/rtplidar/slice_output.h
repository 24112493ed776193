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

/// Used by the streaming thread, except for the counts.
class SliceOutput {
 public:
  explicit SliceOutput(GstRTPBaseDepayload* element) : element_(element) {}

  /// Pushes the slices; those of one config form a list. Drops slices of a coder that the next
  /// element does not accept, and slices of formats that change too often. Warns once of each. The
  /// first slice after dropped ones is marked DISCONT.
  void Push(std::vector<rtp::ReceivedSlice> slices, Time now);
  /// Resets all state, counts included. The caller holds the element's lock.
  void Reset();
  /// Call it if the times of Push() begin anew.
  void ResetTime() { changes_ = {kFormatChanges, kFormatChangePeriod}; }

  guint64 not_accepted() const { return not_accepted_; }
  guint64 format_changes() const { return format_changes_; }

 private:
  using Config = std::shared_ptr<const rtp::StreamConfig>;

  bool MayChangeTo(const Config& config, Time now);
  bool SetCapsOf(const rtp::StreamConfig& config);

  // A change of format costs downstream much more than the bytes of a slice: caps of up to 200 kB,
  // an event per queue, a channel of a recording, a NATS message.
  static constexpr int kFormatChanges = 8;
  static constexpr Duration kFormatChangePeriod = std::chrono::seconds(1);

  GstRTPBaseDepayload* element_;
  Config config_;  // of the caps on the src pad
  Config asked_;   // of the caps that were offered last
  Allowance changes_{kFormatChanges, kFormatChangePeriod};
  bool discont_ = false;  // slices before the next one were dropped
  bool warned_of_coder_ = false;
  bool warned_of_changes_ = false;
  std::atomic<guint64> not_accepted_{0};
  std::atomic<guint64> format_changes_{0};
};

}  // namespace lidar::gst
