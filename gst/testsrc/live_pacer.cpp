// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/testsrc/live_pacer.h"

#include "gst/common/refs.h"

namespace lidar::gst {
namespace {

using ClockPtr = std::unique_ptr<GstClock, Unref>;

std::optional<GstClockTime> RunningTime(GstElement* element) {
  const ClockPtr clock(gst_element_get_clock(element));
  if (!clock) return std::nullopt;
  const GstClockTime now = gst_clock_get_time(clock.get());
  const GstClockTime base = gst_element_get_base_time(element);
  return now > base ? now - base : 0;
}

}  // namespace

void LivePacer::Start() {
  start_ = RunningTime(GST_ELEMENT(source_)).value_or(0);
  started_ = true;
}

void LivePacer::MeasureUnixOffset() {
  const auto now = RunningTime(GST_ELEMENT(source_)).value_or(0);
  unix_offset_ =
      g_get_real_time() * static_cast<gint64>(GST_USECOND) - static_cast<GstClockTimeDiff>(now);
}

GstClockTime LivePacer::ToRunningTime(Duration t) const {
  return start_ + static_cast<GstClockTime>(t.count());
}

GstClockTime LivePacer::ToUnixTime(Duration t) const {
  return static_cast<GstClockTime>(unix_offset_ + static_cast<GstClockTimeDiff>(ToRunningTime(t)));
}

std::optional<Duration> LivePacer::Now() const {
  const auto now = RunningTime(GST_ELEMENT(source_));
  if (!now) return std::nullopt;
  return Duration{static_cast<std::int64_t>(*now) - static_cast<std::int64_t>(start_)};
}

GstFlowReturn LivePacer::WaitUntil(Duration t) {
  while (Wait(ToRunningTime(t)) == GST_CLOCK_UNSCHEDULED) {
    const GstFlowReturn flow = gst_base_src_wait_playing(source_);
    if (flow != GST_FLOW_OK) return flow;
  }
  return GST_FLOW_OK;
}

GstClockReturn LivePacer::Wait(GstClockTime running_time) {
  GstElement* element = GST_ELEMENT(source_);
  const ClockPtr clock(gst_element_get_clock(element));
  if (!clock) return GST_CLOCK_OK;
  GstClockID id =
      gst_clock_new_single_shot_id(clock.get(), gst_element_get_base_time(element) + running_time);
  bool flushing = false;
  {
    std::lock_guard lock(mutex_);
    flushing = flushing_;
    if (!flushing) wait_ = id;
  }
  const GstClockReturn result = flushing ? GST_CLOCK_UNSCHEDULED : gst_clock_id_wait(id, nullptr);
  {
    std::lock_guard lock(mutex_);
    wait_ = nullptr;
  }
  gst_clock_id_unref(id);
  return result;
}

void LivePacer::SetFlushing(bool flushing) {
  std::lock_guard lock(mutex_);
  flushing_ = flushing;
  if (flushing && wait_ != nullptr) gst_clock_id_unschedule(wait_);
}

}  // namespace lidar::gst
