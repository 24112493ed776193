// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/entry_gate.h"

#include <utility>

namespace lidar::gst {
namespace {

/// Returns the entry time, corrected by the shift `s` if it applies (see EntryShift).
GstClockTime Shifted(EntryShift* s, GstClockTime entry, GstClockTime base_time, GstClockTime now) {
  if (s->due) *s = {false, false, base_time, now > entry ? now - entry : 0};
  if (std::exchange(s->moved, false)) s->base_time = base_time;
  return s->base_time == base_time ? entry + s->shift : entry;
}

/// Returns the clock time at which input that is not live may enter the queue. It is the time at
/// which a live source would have produced the input.
GstClockTime EntryTime(GstElement* element, const TxStream& stream, GstBuffer* buffer) {
  const GstClockTime pts = GST_BUFFER_PTS(buffer);
  if (!GST_CLOCK_TIME_IS_VALID(pts) || stream.segment.format != GST_FORMAT_TIME)
    return GST_CLOCK_TIME_NONE;
  const GstClockTime running = gst_segment_to_running_time(&stream.segment, GST_FORMAT_TIME, pts);
  if (!GST_CLOCK_TIME_IS_VALID(running)) return GST_CLOCK_TIME_NONE;
  return running + gst_element_get_base_time(element);
}

}  // namespace

void EntryGate::Set(bool open, GstFlowReturn flow) {
  open_ = open;
  flow_ = flow;
  changed_.notify_all();
}

void EntryGate::Close(const TxStreams& streams) {
  Set(false, GST_FLOW_FLUSHING);
  for (const auto& stream : streams) Release(*stream);
}

void EntryGate::set_playing(const TxStreams& streams, bool playing) {
  playing_ = playing;
  changed_.notify_all();
  for (const auto& stream : streams) {
    stream->entry_shift.moved = playing;
    if (!playing) Release(*stream);
  }
}

void EntryGate::Release(TxStream& stream) {
  if (stream.entry_wait != nullptr) gst_clock_id_unschedule(stream.entry_wait);
  changed_.notify_all();
}

GstFlowReturn EntryGate::Check(const TxStream& stream) const {
  if (!open_ || stream.flushing) return GST_FLOW_FLUSHING;
  if (stream.eos) return GST_FLOW_EOS;
  return flow_;
}

void EntryGate::Wait(TxLock& lock, GstElement* element, Duration max_age, TxStream& stream,
                     GstBuffer* first) {
  WaitForRoom(lock, max_age, stream);
  WaitForTime(lock, element, stream, first);
}

/// Waits until the queue has room. Before PLAYING, only an empty queue has room, which lets the
/// packets pass that a sink needs to preroll.
void EntryGate::WaitForRoom(TxLock& lock, Duration max_age, const TxStream& stream) {
  changed_.wait(lock, [&] {
    if (Check(stream) != GST_FLOW_OK) return true;
    if (!playing_) return stream.queue.empty();
    return stream.HeadAge(TimeOf(clock_)) < max_age;
  });
}

/// Waits for the entry time of `first`. Returns at once if the pipeline has no clock or does not
/// play.
void EntryGate::WaitForTime(TxLock& lock, GstElement* element, TxStream& stream, GstBuffer* first) {
  GstClockTime entry = EntryTime(element, stream, first);
  GstClock* clock = gst_element_get_clock(element);
  if (clock == nullptr) return;
  if (GST_CLOCK_TIME_IS_VALID(entry) && playing_ && Check(stream) == GST_FLOW_OK) {
    entry = Shifted(&stream.entry_shift, entry, gst_element_get_base_time(element),
                    gst_clock_get_time(clock));
    GstClockID id = gst_clock_new_single_shot_id(clock, entry);
    stream.entry_wait = id;
    lock.unlock();
    gst_clock_id_wait(id, nullptr);
    lock.lock();
    stream.entry_wait = nullptr;
    gst_clock_id_unref(id);
  }
  gst_object_unref(clock);
}

}  // namespace lidar::gst
