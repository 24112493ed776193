// SPDX-License-Identifier: LGPL-2.1-or-later
// What a source that can be sought does with its segment, which is of time.
#pragma once
#include <gst/gst.h>

namespace lidar::gst {

/// What a seek event asks for.
class Seek {
 public:
  explicit Seek(GstEvent* event);

  /// Only forward, and by time.
  bool IsPossible() const { return rate_ > 0 && format_ == GST_FORMAT_TIME; }
  bool flushes() const { return (flags_ & GST_SEEK_FLAG_FLUSH) != 0; }
  guint32 seqnum() const { return seqnum_; }
  void ApplyTo(GstSegment* segment) const;

 private:
  gdouble rate_ = 1;
  GstFormat format_ = GST_FORMAT_UNDEFINED;
  GstSeekFlags flags_ = GST_SEEK_FLAG_NONE;
  GstSeekType start_type_ = GST_SEEK_TYPE_NONE;
  gint64 start_ = 0;
  GstSeekType stop_type_ = GST_SEEK_TYPE_NONE;
  gint64 stop_ = 0;
  guint32 seqnum_;
};

/// Duration, position, seeking and segment. False where another one has to answer.
bool AnswerBySegment(const GstSegment& segment, GstQuery* query);

}  // namespace lidar::gst
