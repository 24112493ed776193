// SPDX-License-Identifier: LGPL-2.1-or-later
// Ties the stamps of a live source to the pipeline's clock and to UTC.
#pragma once
#include <gst/base/gstbasesrc.h>

#include <atomic>
#include <mutex>
#include <optional>

#include "src/base/time.h"

namespace lidar::gst {

/// Each source has a pacer, and must outlive it. Only SetFlushing() and MeasureUnixOffset() may be
/// called by other threads than the streaming thread.
class LivePacer {
 public:
  explicit LivePacer(GstBaseSrc* source) : source_(source) {}

  /// Sets stream time zero to the present. Call it when the pipeline plays.
  void Start();
  void Stop() { started_ = false; }
  bool started() const { return started_; }
  /// Waits until stream time `t`, through pauses of the pipeline. Returns FLUSHING if it stops.
  GstFlowReturn WaitUntil(Duration t);
  /// Present stream time; nothing without a clock.
  std::optional<Duration> Now() const;
  GstClockTime ToRunningTime(Duration t) const;
  GstClockTime ToUnixTime(Duration t) const;
  /// Called by unlock and unlock_stop. Any thread may call it.
  void SetFlushing(bool flushing);

  /// Call it whenever the pipeline begins to play, because the running time stops in a pause, but
  /// UTC does not.
  void MeasureUnixOffset();

 private:
  GstClockReturn Wait(GstClockTime running_time);

  GstBaseSrc* source_;
  bool started_ = false;
  GstClockTime start_ = 0;                        // running time of stream time zero
  std::atomic<GstClockTimeDiff> unix_offset_{0};  // UTC less running time
  std::mutex mutex_;  // guards the members below; not held while waiting
  bool flushing_ = false;
  GstClockID wait_ = nullptr;
};

}  // namespace lidar::gst
