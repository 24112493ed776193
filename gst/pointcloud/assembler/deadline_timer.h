// SPDX-License-Identifier: LGPL-2.1-or-later
// Lets a thread wait for the earliest of several deadlines, on the clock of an element.
#pragma once
#include <gst/gst.h>

#include <condition_variable>
#include <functional>
#include <mutex>

namespace lidar::gst {

/// A timer for a thread that waits for deadlines. A mutex guards the deadlines, and must be held
/// during every call.
class DeadlineTimer {
 public:
  /// Waits until the earliest deadline, with the mutex unlocked. `next` returns this deadline in
  /// the running time of the element, or NONE if there is no deadline. Returns true if the deadline
  /// has passed. Returns false if the thread was woken; the thread must then check flushing() and
  /// wait again.
  bool Wait(std::unique_lock<std::mutex>* lock, GstElement* element,
            const std::function<GstClockTime()>& next);
  /// Notes that the deadlines have changed, or that the element got a clock. `next` is the earliest
  /// deadline.
  void Update(GstClockTime next);
  /// Makes Wait() return at once while `flushing` is true.
  void SetFlushing(bool flushing);
  bool flushing() const { return flushing_; }

 private:
  std::condition_variable changed_;
  bool flushing_ = true;
  GstClockID wait_ = nullptr;
  GstClockTime deadline_ = GST_CLOCK_TIME_NONE;  // the deadline that Wait() waits for now
};

}  // namespace lidar::gst
