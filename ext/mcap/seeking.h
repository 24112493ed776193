// SPDX-License-Identifier: LGPL-2.1-or-later
// The segment of a source with seeks by time.
#pragma once
#include <gst/gst.h>

#include <optional>

#include "gst/common/refs.h"

namespace lidar::gst {

/// The request of a seek event.
class Seek {
 public:
  explicit Seek(GstEvent* event);

  /// Returns the segment after the seek. Returns nothing unless the seek is forward, by time, and
  /// to a time with data.
  std::optional<GstSegment> AppliedTo(GstSegment played) const;
  /// Returns the segment that the task plays after the seek. `made` is the result of AppliedTo(),
  /// `played` the segment when the task paused. Without a flush the running time of `played`
  /// continues.
  GstSegment Begun(GstSegment made, const GstSegment& played) const;
  bool flushes() const { return (flags_ & GST_SEEK_FLAG_FLUSH) != 0; }
  guint32 seqnum() const { return gst_event_get_seqnum(event_.get()); }

 private:
  EventPtr event_;
  gdouble rate_ = 1;
  GstFormat format_ = GST_FORMAT_UNDEFINED;
  GstSeekFlags flags_ = GST_SEEK_FLAG_NONE;
  GstSeekType start_type_ = GST_SEEK_TYPE_NONE;
};

/// Answers duration, position, seeking and segment. Returns false for other queries.
bool AnswerBySegment(const GstSegment& segment, GstQuery* query);

}  // namespace lidar::gst
