// SPDX-License-Identifier: LGPL-2.1-or-later
// Sets the times of clouds from files. Times come from upstream, or are computed from cloud
// numbers.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <utility>

#include "gst/common/fields.h"
#include "gst/common/refs.h"
#include "gst/pointcloud/parse/cloud_timeline.h"

namespace lidar::gst {

/// The number of clouds per second, as in caps or in the property framerate.
struct FrameRate {
  gint n = 0;  // 0 if not known
  gint d = 1;
};
template <>
struct Kind<FrameRate> {
  static GType Type() { return GST_TYPE_FRACTION; }
  static GParamSpec* Spec(const SpecArgs& a, FrameRate initial) {
    return gst_param_spec_fraction(a.name, a.name, a.blurb, 0, 1, G_MAXINT, 1, initial.n, initial.d,
                                   a.flags);
  }
  static void Set(FrameRate* field, const GValue* v) {
    *field = {gst_value_get_fraction_numerator(v), gst_value_get_fraction_denominator(v)};
  }
  static void Get(FrameRate value, GValue* v) { gst_value_set_fraction(v, value.n, value.d); }
};

/// Sets times, capture times and numbers of clouds. Only the streaming thread may use it, except
/// for the timeline.
class CloudStamper {
 public:
  CloudTimeline& timeline() { return timeline_; }
  const FrameRate& rate() const { return rate_; }
  void SetRate(const FrameRate& rate);
  /// Returns the number of clouds that were pushed or left out so far.
  guint64 count() const { return place_.next; }
  /// Returns true if upstream's buffers have timestamps.
  bool times_given() const { return times_given_; }

  /// Keeps upstream's segment if its format is time. Otherwise makes a segment in time. Takes
  /// ownership of the event.
  void TakeSegment(GstEvent* event);
  /// Returns the segment that must be pushed before the next cloud, or NULL if it has been pushed.
  EventPtr NextSegment() { return std::move(segment_); }
  /// Sets the size of every cloud in bytes, or 0 if sizes differ. If the size is known, the parser
  /// can convert seeks and queries from time to the bytes of upstream.
  void SetCloudSize(gsize bytes);
  /// Returns the duration of `clouds` clouds.
  GstClockTime TimeOf(guint64 clouds) const { return Grid().TimeOf(clouds); }
  /// Sets times and the number of a cloud. A missing capture time is set as if the sensor had
  /// started when the first cloud arrived. A cloud that is not a slice gets a scan number of its
  /// own.
  void Stamp(GstBuffer* cloud);
  /// Counts a cloud that is not pushed. No other cloud gets its time.
  void LeaveOut() { ++place_.next; }
  /// Returns true if the next cloud has already been pushed, before a seek that continues at the
  /// current position.
  bool HasGone() const { return place_.next < place_.shown; }
  void Flush(bool restarts_time);
  void Reset();

 private:
  CloudTimeline::Grid Grid() const;
  void ShowGrid();
  void StampCapture(GstBuffer* cloud);
  static void NumberScan(GstBuffer* cloud, guint64 number);

  CloudTimeline timeline_;
  FrameRate rate_;
  bool times_given_ = false;
  EventPtr segment_;
  gsize cloud_size_ = 0;
  std::optional<GstClockTimeDiff> unix_offset_;  // difference between capture times and timestamps
  CloudTimeline::Place place_;
};

}  // namespace lidar::gst
