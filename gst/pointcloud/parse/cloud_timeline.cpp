// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/parse/cloud_timeline.h"

#include <algorithm>

#include "gst/common/seek_range.h"

namespace lidar::gst {

/// Returns the cloud at `time`. TimeOf() rounds down, so if a cloud begins at `time`, a plain
/// division may return the cloud before it.
guint64 CloudTimeline::Grid::CloudAt(GstClockTime time) const {
  const guint64 cloud = gst_util_uint64_scale(time, rate_n, rate_d * GST_SECOND);
  return TimeOf(cloud + 1) <= time ? cloud + 1 : cloud;
}

void CloudTimeline::SetGrid(const Grid& grid) {
  const std::lock_guard lock(mutex_);
  grid_ = grid;
}

void CloudTimeline::Reset() {
  const std::lock_guard lock(mutex_);
  grid_ = {};
  sought_.reset();
  gst_segment_init(&segment_, GST_FORMAT_TIME);
}

/// Returns the running time at the end of the last cloud. The caller must hold the mutex.
GstClockTime CloudTimeline::Gone() const {
  return gst_segment_to_running_time(&segment_, GST_FORMAT_TIME, segment_.position);
}

/// Starts a new segment at the beginning of `cloud`. The caller must hold the mutex.
void CloudTimeline::BeginAt(guint64 cloud) {
  gst_segment_init(&segment_, GST_FORMAT_TIME);
  segment_.start = segment_.time = segment_.position = grid_.TimeOf(cloud);
}

EventPtr CloudTimeline::Continue(guint64 next) {
  const std::lock_guard lock(mutex_);
  const GstClockTime gone = Gone();
  BeginAt(next);
  segment_.base = gone;
  return EventPtr(gst_event_new_segment(&segment_));
}

EventPtr CloudTimeline::ToTime(GstEvent* event, Place* place) {
  const GstSegment* bytes = nullptr;
  gst_event_parse_segment(event, &bytes);
  const guint32 seqnum = gst_event_get_seqnum(event);
  const std::lock_guard lock(mutex_);
  const bool counts = bytes->format == GST_FORMAT_BYTES && grid_.cloud_bytes > 0;
  if (counts) place->next = bytes->start / grid_.cloud_bytes;
  // More clouds may have been pushed since the seek was requested.
  const GstClockTime end = segment_.position;
  const GstClockTime gone = Gone();
  if (sought_ && sought_->seqnum == seqnum) {
    segment_ = sought_->segment;
    if (sought_->goes_on) {
      GoOnFrom(end, &segment_);
      place->shown = grid_.CloudAt(segment_.position);
    }
  } else {
    BeginAt(place->next);
  }
  segment_.base = gone;
  sought_.reset();
  EventPtr segment(gst_event_new_segment(&segment_));
  gst_event_set_seqnum(segment.get(), seqnum);
  return segment;
}

void CloudTimeline::NotePosition(GstClockTime end) {
  const std::lock_guard lock(mutex_);
  // If the segment has no stop position, `stop` is the largest number.
  segment_.position = std::min(end, segment_.stop);
}

void CloudTimeline::RestartTime() {
  const std::lock_guard lock(mutex_);
  segment_.base = segment_.offset = 0;
  segment_.position = segment_.start;
}

EventPtr CloudTimeline::EndInTime(GstEvent* done) const {
  const EventPtr owner(done);
  const std::lock_guard lock(mutex_);
  EventPtr in_time(
      gst_event_new_segment_done(GST_FORMAT_TIME, static_cast<gint64>(segment_.position)));
  gst_event_set_seqnum(in_time.get(), gst_event_get_seqnum(done));
  return in_time;
}

std::optional<GstClockTime> CloudTimeline::Duration(GstPad* sinkpad, const Grid& grid) const {
  gint64 bytes = 0;
  if (!gst_pad_peer_query_duration(sinkpad, GST_FORMAT_BYTES, &bytes) || bytes < 0)
    return std::nullopt;
  return grid.TimeOf(static_cast<guint64>(bytes) / grid.cloud_bytes);
}

bool CloudTimeline::Answer(GstPad* sinkpad, GstQuery* query) const {
  std::unique_lock lock(mutex_);
  const Grid grid = grid_;
  const auto at = static_cast<gint64>(segment_.position);
  lock.unlock();
  if (grid.cloud_bytes == 0) return false;
  GstFormat format = GST_FORMAT_UNDEFINED;
  switch (GST_QUERY_TYPE(query)) {
    case GST_QUERY_DURATION: {
      gst_query_parse_duration(query, &format, nullptr);
      const auto duration = Duration(sinkpad, grid);
      if (format != GST_FORMAT_TIME || !duration) return false;
      gst_query_set_duration(query, format, static_cast<gint64>(*duration));
      return true;
    }
    case GST_QUERY_POSITION:
      gst_query_parse_position(query, &format, nullptr);
      if (format != GST_FORMAT_TIME) return false;
      gst_query_set_position(query, format, at);
      return true;
    case GST_QUERY_SEEKING: {
      gst_query_parse_seeking(query, &format, nullptr, nullptr, nullptr);
      if (format != GST_FORMAT_TIME) return false;
      const QueryPtr bytes(gst_query_new_seeking(GST_FORMAT_BYTES));
      gboolean seekable = FALSE;
      if (gst_pad_peer_query(sinkpad, bytes.get()))
        gst_query_parse_seeking(bytes.get(), nullptr, &seekable, nullptr, nullptr);
      const auto duration = Duration(sinkpad, grid);
      gst_query_set_seeking(query, format, seekable, 0,
                            duration ? static_cast<gint64>(*duration) : -1);
      return true;
    }
    default:
      return false;
  }
}

std::optional<bool> CloudTimeline::Seek(GstPad* sinkpad, GstEvent* event) {
  gdouble rate = 1;
  GstFormat format = GST_FORMAT_UNDEFINED;
  GstSeekFlags flags = GST_SEEK_FLAG_NONE;
  GstSeekType start_type = GST_SEEK_TYPE_NONE;
  gst_event_parse_seek(event, &rate, &format, &flags, &start_type, nullptr, nullptr, nullptr);
  Sought sought;
  sought.goes_on = start_type == GST_SEEK_TYPE_NONE && (flags & GST_SEEK_FLAG_FLUSH) == 0;
  sought.seqnum = gst_event_get_seqnum(event);
  std::unique_lock lock(mutex_);
  const Grid grid = grid_;
  sought.segment = segment_;
  lock.unlock();
  if (grid.cloud_bytes == 0 || format != GST_FORMAT_TIME) return std::nullopt;
  if (rate <= 0) return false;
  GstSegment& segment = sought.segment;
  if (const auto duration = Duration(sinkpad, grid)) segment.duration = *duration;
  if (!ApplySeek(event, &segment)) return false;
  const guint64 first = grid.CloudAt(segment.position);
  if (flags & GST_SEEK_FLAG_KEY_UNIT) {
    segment.start = segment.time = segment.position = grid.TimeOf(first);
    segment.offset = 0;
  }
  const bool ends = GST_CLOCK_TIME_IS_VALID(segment.stop) && segment.stop > 0;
  const guint64 past_last = ends ? grid.CloudAt(segment.stop - 1) + 1 : 0;
  if (std::max(first, past_last) > static_cast<guint64>(G_MAXINT64) / grid.cloud_bytes)
    return false;
  // A stop position of -1 means none. It replaces an earlier stop position.
  EventPtr bytes(
      gst_event_new_seek(rate, GST_FORMAT_BYTES, flags, GST_SEEK_TYPE_SET,
                         static_cast<gint64>(first * grid.cloud_bytes), GST_SEEK_TYPE_SET,
                         ends ? static_cast<gint64>(past_last * grid.cloud_bytes) : gint64{-1}));
  gst_event_set_seqnum(bytes.get(), sought.seqnum);
  lock.lock();
  sought_ = sought;
  lock.unlock();
  if (gst_pad_push_event(sinkpad, bytes.release())) return true;
  lock.lock();
  sought_.reset();
  return false;
}

}  // namespace lidar::gst
