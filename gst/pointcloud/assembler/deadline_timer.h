// SPDX-License-Identifier: LGPL-2.1-or-later
// A thread's wait for the earliest of some deadlines, on the clock of an element.
#pragma once
#include <gst/gst.h>

#include <condition_variable>
#include <functional>
#include <mutex>

namespace lidar::gst {

/// Every call is made with the same mutex held, which guards the deadlines too.
class DeadlineTimer {
 public:
  /// Waits without the mutex until the earliest deadline, which `next` has in the element's running
  /// time (NONE: no deadline). Returns true when it has passed. Returns false if the thread was
  /// woken: then the thread checks flushing() and waits again.
  bool Wait(std::unique_lock<std::mutex>* lock, GstElement* element,
            const std::function<GstClockTime()>& next);
  /// Call it when the deadlines change or the element gets a clock. `next` is the earliest
  /// deadline.
  void Update(GstClockTime next);
  /// Wait() returns at once while flushing.
  void SetFlushing(bool flushing);
  bool flushing() const { return flushing_; }

 private:
  std::condition_variable changed_;
  bool flushing_ = true;
  GstClockID wait_ = nullptr;
  GstClockTime deadline_ = GST_CLOCK_TIME_NONE;  // deadline of the present wait
};

}  // namespace lidar::gst
