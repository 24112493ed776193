// SPDX-License-Identifier: LGPL-2.1-or-later
// Applies seeks by time to a segment, if there is something to play.
#pragma once
#include <gst/gst.h>

#include <algorithm>

namespace lidar::gst {

/// The range that a seek asks for, with times counted from the beginning.
struct SeekRange {
  GstSeekType start_type = GST_SEEK_TYPE_NONE;
  GstClockTime start = 0;
  GstSeekType stop_type = GST_SEEK_TYPE_NONE;
  GstClockTime stop = GST_CLOCK_TIME_NONE;

  bool IsSound(const GstSegment& now) const {
    const GstClockTime from = start_type == GST_SEEK_TYPE_NONE ? now.position : start;
    const GstClockTime to = stop_type == GST_SEEK_TYPE_NONE ? now.stop : stop;
    return GST_CLOCK_TIME_IS_VALID(from) && (!GST_CLOCK_TIME_IS_VALID(to) || from <= to);
  }
};

inline GstClockTime FromBeginning(GstSeekType* type, gint64 time, const GstSegment& segment) {
  if (*type != GST_SEEK_TYPE_END) return static_cast<GstClockTime>(time);
  if (!GST_CLOCK_TIME_IS_VALID(segment.duration)) return GST_CLOCK_TIME_NONE;
  *type = GST_SEEK_TYPE_SET;
  const auto end = static_cast<gint64>(std::min<GstClockTime>(segment.duration, G_MAXINT64));
  return static_cast<GstClockTime>(std::max<gint64>(end + std::min<gint64>(time, 0), 0));
}

/// Applies the seek `event` to `segment`, whose format is time. Returns false and changes nothing
/// for an empty range, which GStreamer treats as the caller's error.
inline bool ApplySeek(GstEvent* event, GstSegment* segment) {
  gdouble rate = 1;
  GstSeekFlags flags = GST_SEEK_FLAG_NONE;
  SeekRange range;
  gint64 start = 0;
  gint64 stop = 0;
  gst_event_parse_seek(event, &rate, nullptr, &flags, &range.start_type, &start, &range.stop_type,
                       &stop);
  range.start = FromBeginning(&range.start_type, start, *segment);
  range.stop = FromBeginning(&range.stop_type, stop, *segment);
  // GStreamer also treats a start of -1 as 0.
  if (range.start_type == GST_SEEK_TYPE_SET && start == -1) range.start = 0;
  return range.IsSound(*segment) &&
         gst_segment_do_seek(segment, rate, GST_FORMAT_TIME, flags, range.start_type, range.start,
                             range.stop_type, range.stop, nullptr) != FALSE;
}

/// Completes a seek without start and flush. Playback continued meanwhile, so the segment continues
/// from `end`, the time that playback has reached.
inline void GoOnFrom(GstClockTime end, GstSegment* segment) {
  segment->position = std::min(std::max(end, segment->position), segment->stop);
  segment->offset = segment->position - segment->start;
}

}  // namespace lidar::gst
