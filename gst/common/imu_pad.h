// SPDX-License-Identifier: LGPL-2.1-or-later
// The pad `imu` of a source of clouds. It pushes the samples of an inertial measurement unit.
#pragma once
#include <gst/base/gstbasesrc.h>

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include "gst/common/imu_caps.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/base/imu_sample.h"

namespace lidar::gst {

/// Pushes samples on a pad that it adds to `source`. The stream has the same group id as the clouds
/// on the pad src, and ends when the clouds end. If the pad is not linked or is flushing, this is
/// not an error.
class ImuPad {
 public:
  explicit ImuPad(GstBaseSrc* source) : source_(source) {
    gst_segment_init(&segment_, GST_FORMAT_TIME);
  }
  ~ImuPad() {
    if (pad_ == nullptr) return;
    gst_pad_remove_probe(GST_BASE_SRC_PAD(source_), end_of_clouds_);
    gst_pad_set_active(pad_, FALSE);
    gst_element_remove_pad(GST_ELEMENT(source_), pad_);
  }
  ImuPad(const ImuPad&) = delete;
  ImuPad& operator=(const ImuPad&) = delete;

  /// Pushes `samples`. Does nothing if there are none, or if `pts` is before the segment. `pts` is
  /// the time of the first sample. The first call adds the pad.
  void Push(const std::vector<ImuSample>& samples, const ImuToSensor& imu_to_sensor,
            GstClockTime pts) {
    if (samples.empty() || pts < segment_.start) return;
    {
      const std::lock_guard lock(mutex_);
      if (flushing_) return;
    }
    Prepare(imu_to_sensor);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(samples.size() * kImuSampleSize);
    for (const ImuSample& sample : samples) WriteImuSample(sample, &bytes);
    GstBuffer* buffer = gst_buffer_new_memdup(bytes.data(), bytes.size());
    last_pts_ = std::max(last_pts_, pts);
    GST_BUFFER_PTS(buffer) = last_pts_;
    const auto captured = samples.front().time.time_since_epoch().count();
    gst_lidar_buffer_set_capture_time(buffer,
                                      static_cast<GstClockTime>(std::max<gint64>(captured, 0)));
    gst_pad_push(pad_, buffer);
  }

  /// Sets the segment of later samples. Must not be called while Push() runs.
  void SetSegment(const GstSegment& segment) {
    segment_ = segment;
    segment_pending_ = true;
    last_pts_ = 0;
  }
  /// Starts a flush. Must be called before a flushing seek on the clouds. Any thread may call it.
  void StartFlush(guint32 seqnum) { Flush(true, gst_event_new_flush_start(), seqnum); }
  /// Ends a flush. Must be called before clouds are pushed again. Any thread may call it.
  void StopFlush() {
    std::unique_lock lock(mutex_);
    if (!flushing_) return;
    const guint32 seqnum = flush_seqnum_;
    lock.unlock();
    Flush(false, gst_event_new_flush_stop(TRUE), seqnum);
  }

 private:
  void MakePad() {
    GstElement* element = GST_ELEMENT(source_);
    GstPad* pad = gst_pad_new_from_template(
        gst_element_class_get_pad_template(GST_ELEMENT_GET_CLASS(element), "imu"), "imu");
    gst_pad_use_fixed_caps(pad);
    gst_pad_set_query_function(pad, Query);
    gst_pad_set_event_function(pad, Event);
    gst_pad_set_active(pad, TRUE);
    {
      const std::lock_guard lock(mutex_);
      pad_ = pad;
    }
    gst_pad_push_event(pad_, StreamStart(pad_));
    // The base class may end the clouds by itself, because of num-buffers or of an EOS event that
    // was sent to the element. The probe ends the samples in this case, too.
    end_of_clouds_ =
        gst_pad_add_probe(GST_BASE_SRC_PAD(source_), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM,
                          EndWithClouds, gst_object_ref(pad_), gst_object_unref);
  }

  /// Pushes the first events before the pad is added, so that a handler of pad-added finds them on
  /// the pad.
  void Prepare(const ImuToSensor& imu_to_sensor) {
    const bool first = pad_ == nullptr;
    if (first) MakePad();
    if (first || imu_to_sensor_ != imu_to_sensor) {
      imu_to_sensor_ = imu_to_sensor;
      gst_pad_push_event(pad_, gst_event_new_caps(ImuCaps(imu_to_sensor).get()));
    }
    if (std::exchange(segment_pending_, false))
      gst_pad_push_event(pad_, gst_event_new_segment(&segment_));
    if (first) gst_element_add_pad(GST_ELEMENT(source_), pad_);
  }

  GstEvent* StreamStart(GstPad* pad) const {
    const StringPtr id(gst_pad_create_stream_id(pad, GST_ELEMENT(source_), "imu"));
    GstEvent* event = gst_event_new_stream_start(id.get());
    const EventPtr clouds(
        gst_pad_get_sticky_event(GST_BASE_SRC_PAD(source_), GST_EVENT_STREAM_START, 0));
    guint group = 0;
    if (clouds && gst_event_parse_group_id(clouds.get(), &group))
      gst_event_set_group_id(event, group);
    return event;
  }

  void Flush(bool flushing, GstEvent* event, guint32 seqnum) {
    std::unique_lock lock(mutex_);
    flushing_ = flushing;
    flush_seqnum_ = seqnum;
    const PadPtr pad(pad_ != nullptr ? GST_PAD(gst_object_ref(pad_)) : nullptr);
    lock.unlock();
    gst_event_set_seqnum(event, seqnum);
    if (pad)
      gst_pad_push_event(pad.get(), event);
    else
      gst_event_unref(event);
  }

  static GstPadProbeReturn EndWithClouds(GstPad*, GstPadProbeInfo* info, gpointer imu) {
    GstEvent* event = GST_PAD_PROBE_INFO_EVENT(info);
    if (GST_EVENT_TYPE(event) == GST_EVENT_EOS || GST_EVENT_TYPE(event) == GST_EVENT_SEGMENT_DONE)
      gst_pad_push_event(GST_PAD(imu), gst_event_ref(event));
    return GST_PAD_PROBE_OK;
  }

  /// Answers queries. Samples have no latency. Queries about positions and times are passed to the
  /// pad src.
  static gboolean Query(GstPad* pad, GstObject* parent, GstQuery* query) {
    switch (GST_QUERY_TYPE(query)) {
      case GST_QUERY_LATENCY:
        gst_query_set_latency(query, gst_base_src_is_live(GST_BASE_SRC(parent)), 0,
                              GST_CLOCK_TIME_NONE);
        return TRUE;
      case GST_QUERY_DURATION:
      case GST_QUERY_POSITION:
      case GST_QUERY_SEEKING:
      case GST_QUERY_SEGMENT:
        return gst_pad_query(GST_BASE_SRC_PAD(parent), query);
      default:
        return gst_pad_query_default(pad, parent, query);
    }
  }

  /// Passes a seek to the pad src, because it applies to clouds and samples.
  static gboolean Event(GstPad* pad, GstObject* parent, GstEvent* event) {
    if (GST_EVENT_TYPE(event) != GST_EVENT_SEEK) return gst_pad_event_default(pad, parent, event);
    return gst_pad_send_event(GST_BASE_SRC_PAD(parent), event);
  }

  GstBaseSrc* const source_;
  // Guards flushing_. Also guards pad_ when other threads use it.
  std::mutex mutex_;
  bool flushing_ = false;
  guint32 flush_seqnum_ = 0;
  GstPad* pad_ = nullptr;  // owned by the element
  GstSegment segment_{};
  bool segment_pending_ = true;
  gulong end_of_clouds_ = 0;     // id of the probe on the pad src, set with pad_
  ImuToSensor imu_to_sensor_{};  // as in the current caps
  GstClockTime last_pts_ = 0;
};

}  // namespace lidar::gst
