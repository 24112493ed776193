// SPDX-License-Identifier: LGPL-2.1-or-later
// Times of clouds from files: upstream's, or computed from the clouds' numbers.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <utility>

#include "gst/common/fields.h"
#include "gst/common/refs.h"
#include "gst/pointcloud/parse/cloud_timeline.h"

namespace lidar::gst {

/// Clouds per second in caps or property.
struct FrameRate {
  gint n = 0;  // 0: not known
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

/// For the streaming thread, except for the timeline.
class CloudStamper {
 public:
  CloudTimeline& timeline() { return timeline_; }
  const FrameRate& rate() const { return rate_; }
  /// Sets a known rate.
  void SetRate(const FrameRate& rate);
  /// Number of clouds pushed or left out.
  guint64 count() const { return place_.next; }
  /// Returns true if upstream's buffers have timestamps.
  bool times_given() const { return times_given_; }

  /// Keeps upstream's segment if its format is time, and makes one otherwise. Takes the event.
  void TakeSegment(GstEvent* event);
  /// Returns the segment to push before the next cloud; NULL if it was pushed already.
  EventPtr NextSegment() { return std::move(segment_); }
  /// Sets the size of all clouds in bytes; 0: sizes differ. With a size, the parser converts
  /// seeks and queries in time to bytes for upstream.
  void SetCloudSize(gsize bytes);
  /// Returns the time that `clouds` take.
  GstClockTime TimeOf(guint64 clouds) const { return Grid().TimeOf(clouds); }
  /// Sets a missing capture time as if the sensor had begun when the first cloud came. Numbers a
  /// cloud that is not a slice as a scan of its own.
  void Stamp(GstBuffer* cloud);
  /// Leaves out a cloud. Its time stays empty.
  void LeaveOut() { ++place_.next; }
  /// Returns true if the next cloud was pushed before a seek that continues at the current
  /// position.
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
  std::optional<GstClockTimeDiff> unix_offset_;  // from timestamps to capture times
  CloudTimeline::Place place_;
};

}  // namespace lidar::gst
