// SPDX-License-Identifier: LGPL-2.1-or-later
// Seeks by time, and the segment of a source after them.
#pragma once
#include <gst/gst.h>

#include <optional>

#include "gst/common/refs.h"

namespace lidar::gst {

/// The request of a seek event.
class Seek {
 public:
  explicit Seek(GstEvent* event);

  /// Returns the segment after the seek. Returns nothing if the seek is backward, if it is not by
  /// time, or if there are no data at its time.
  std::optional<GstSegment> AppliedTo(GstSegment played) const;
  /// Returns the segment that the task plays after the seek. `made` is the result of AppliedTo().
  /// `played` is the segment that was played when the task paused. If the seek does not flush, the
  /// running time of `played` continues.
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

/// Answers queries for the duration, the position, seeking and the segment. Returns false for other
/// queries.
bool AnswerBySegment(const GstSegment& segment, GstQuery* query);

}  // namespace lidar::gst
