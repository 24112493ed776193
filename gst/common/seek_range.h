// SPDX-License-Identifier: LGPL-2.1-or-later
// Applies seeks in time to a segment, if the resulting range is not empty.
#pragma once
#include <gst/gst.h>

#include <algorithm>

namespace lidar::gst {

/// The range that a seek requests. Its times are counted from the beginning of the stream.
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

/// Applies the seek `event` to `segment`, whose format must be time. If the range is empty, returns
/// false and changes nothing, because GStreamer treats an empty range as a programming error.
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
  // A start of -1 counts as 0, as in GStreamer.
  if (range.start_type == GST_SEEK_TYPE_SET && start == -1) range.start = 0;
  return range.IsSound(*segment) &&
         gst_segment_do_seek(segment, rate, GST_FORMAT_TIME, flags, range.start_type, range.start,
                             range.stop_type, range.stop, nullptr) != FALSE;
}

/// Completes a seek that has neither a start nor a flush. Playback has continued since the seek, so
/// the segment continues at `end`, the time that playback has reached.
inline void GoOnFrom(GstClockTime end, GstSegment* segment) {
  segment->position = std::min(std::max(end, segment->position), segment->stop);
  segment->offset = segment->position - segment->start;
}

}  // namespace lidar::gst
