// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/seeking.h"

#include <algorithm>

#include "gst/common/seek_range.h"

namespace lidar::gst {
namespace {

bool AnswerSegment(const GstSegment& s, GstQuery* query) {
  const auto start = gst_segment_to_stream_time(&s, GST_FORMAT_TIME, s.start);
  const auto stop = GST_CLOCK_TIME_IS_VALID(s.stop)
                        ? gst_segment_to_stream_time(&s, GST_FORMAT_TIME, s.stop)
                        : s.duration;
  gst_query_set_segment(query, s.rate, GST_FORMAT_TIME, static_cast<gint64>(start),
                        static_cast<gint64>(stop));
  return true;
}

}  // namespace

Seek::Seek(GstEvent* event) : event_(gst_event_ref(event)) {
  gst_event_parse_seek(event, &rate_, &format_, &flags_, &start_type_, nullptr, nullptr, nullptr);
}

std::optional<GstSegment> Seek::AppliedTo(GstSegment played) const {
  if (rate_ <= 0 || format_ != GST_FORMAT_TIME || !ApplySeek(event_.get(), &played))
    return std::nullopt;
  return played;
}

GstSegment Seek::Begun(GstSegment made, const GstSegment& played) const {
  if (flushes()) return made;
  const GstClockTime gone =
      std::min(std::max(played.position, played.start + played.offset), played.stop);
  made.base = gst_segment_to_running_time(&played, GST_FORMAT_TIME, gone);
  if (start_type_ == GST_SEEK_TYPE_NONE) GoOnFrom(gone, &made);
  return made;
}

bool AnswerBySegment(const GstSegment& segment, GstQuery* query) {
  GstFormat format = GST_FORMAT_TIME;
  const auto duration = static_cast<gint64>(segment.duration);
  switch (GST_QUERY_TYPE(query)) {
    case GST_QUERY_DURATION:
      gst_query_parse_duration(query, &format, nullptr);
      if (format != GST_FORMAT_TIME) return false;
      gst_query_set_duration(query, format, duration);
      return true;
    case GST_QUERY_POSITION:
      gst_query_parse_position(query, &format, nullptr);
      if (format != GST_FORMAT_TIME) return false;
      gst_query_set_position(query, format, static_cast<gint64>(segment.position));
      return true;
    case GST_QUERY_SEEKING:
      gst_query_parse_seeking(query, &format, nullptr, nullptr, nullptr);
      if (format != GST_FORMAT_TIME) return false;
      gst_query_set_seeking(query, format, TRUE, 0, duration);
      return true;
    case GST_QUERY_SEGMENT:
      return AnswerSegment(segment, query);
    default:
      return false;
  }
}

}  // namespace lidar::gst
