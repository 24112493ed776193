// SPDX-License-Identifier: LGPL-2.1-or-later
// Relates the stream time of a live source to the pipeline's clock and to UTC.
#pragma once
#include <gst/base/gstbasesrc.h>

#include <atomic>
#include <mutex>
#include <optional>

#include "src/base/time.h"

namespace lidar::gst {

/// Makes a live source wait for its stream time. The source must outlive its pacer. Any thread may
/// call SetFlushing() and MeasureUnixOffset(); all other methods must be called by the streaming
/// thread.
class LivePacer {
 public:
  explicit LivePacer(GstBaseSrc* source) : source_(source) {}

  /// Makes the current time stream time 0. Must be called when the pipeline plays.
  void Start();
  void Stop() { started_ = false; }
  bool started() const { return started_; }
  /// Waits until the stream time `t`. If the pipeline pauses, waits until it plays again. Returns
  /// FLUSHING if the pipeline stops.
  GstFlowReturn WaitUntil(Duration t);
  /// Returns the current stream time, or nothing if there is no clock.
  std::optional<Duration> Now() const;
  GstClockTime ToRunningTime(Duration t) const;
  GstClockTime ToUnixTime(Duration t) const;
  /// Makes WaitUntil() return while `flushing` is true. Called by unlock and unlock_stop, in any
  /// thread.
  void SetFlushing(bool flushing);

  /// Measures the difference between UTC and running time. Must be called whenever the pipeline
  /// starts to play, because the running time stops during a pause, but UTC does not.
  void MeasureUnixOffset();

 private:
  GstClockReturn Wait(GstClockTime running_time);

  GstBaseSrc* source_;
  bool started_ = false;
  GstClockTime start_ = 0;                        // the running time at stream time 0
  std::atomic<GstClockTimeDiff> unix_offset_{0};  // UTC minus running time
  // Guards the members below. It is not held while waiting.
  std::mutex mutex_;
  bool flushing_ = false;
  GstClockID wait_ = nullptr;
};

}  // namespace lidar::gst
