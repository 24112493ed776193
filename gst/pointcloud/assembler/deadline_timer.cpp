// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/assembler/deadline_timer.h"

namespace lidar::gst {

bool DeadlineTimer::Wait(std::unique_lock<std::mutex>* lock, GstElement* element,
                         const std::function<GstClockTime()>& next) {
  changed_.wait(*lock, [&] { return flushing_ || GST_CLOCK_TIME_IS_VALID(next()); });
  if (flushing_) return false;
  GstClock* clock = gst_element_get_clock(element);
  if (clock == nullptr) {  // No scan is late before PLAYING.
    changed_.wait(*lock);
    return false;
  }
  deadline_ = next();
  wait_ = gst_clock_new_single_shot_id(clock, gst_element_get_base_time(element) + deadline_);
  gst_object_unref(clock);
  GstClockID wait = wait_;
  lock->unlock();
  const GstClockReturn result = gst_clock_id_wait(wait, nullptr);
  lock->lock();
  wait_ = nullptr;
  gst_clock_id_unref(wait);
  return result != GST_CLOCK_UNSCHEDULED && !flushing_;
}

void DeadlineTimer::Update(GstClockTime next) {
  if (wait_ != nullptr && next < deadline_) gst_clock_id_unschedule(wait_);
  changed_.notify_all();
}

void DeadlineTimer::SetFlushing(bool flushing) {
  flushing_ = flushing;
  if (flushing && wait_ != nullptr) gst_clock_id_unschedule(wait_);
  changed_.notify_all();
}

}  // namespace lidar::gst
