// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/imu_pad.h"

#include <gst/base/gstbasesrc.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "ext/ouster/slice_buffer.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/base/byte_writer.h"
#include "src/ouster/imu_packet.h"

#include "ext/ouster/debug.h"

namespace lidar::gst {
namespace {

constexpr gint kSampleSize = 32;
constexpr const char* kFields =
    "t:U64:0,ax:F32:8,ay:F32:12,az:F32:16,gx:F32:20,gy:F32:24,gz:F32:28";

GstCaps* MakeCaps(const ouster::Metadata& metadata) {
  GstCaps* caps = gst_caps_new_simple(GST_LIDAR_IMU_MEDIA_TYPE, "sample-size", G_TYPE_INT,
                                      kSampleSize, "fields", G_TYPE_STRING, kFields, nullptr);
  GValue list = G_VALUE_INIT;
  gst_value_array_init(&list, 16);
  for (const double v : metadata.imu_to_sensor) {
    GValue value = G_VALUE_INIT;
    g_value_init(&value, G_TYPE_DOUBLE);
    g_value_set_double(&value, v);
    gst_value_array_append_and_take_value(&list, &value);
  }
  gst_caps_set_value(caps, "imu-to-sensor", &list);
  g_value_unset(&list);
  return caps;
}

/// The base class ends the clouds by itself (num-buffers, EOS sent to the element).
GstPadProbeReturn EndWithClouds(GstPad*, GstPadProbeInfo* info, gpointer imu) {
  GstEvent* event = GST_PAD_PROBE_INFO_EVENT(info);
  if (GST_EVENT_TYPE(event) == GST_EVENT_EOS || GST_EVENT_TYPE(event) == GST_EVENT_SEGMENT_DONE)
    gst_pad_push_event(GST_PAD(imu), gst_event_ref(event));
  return GST_PAD_PROBE_OK;
}

/// Packets leave as they come. The pad src answers position queries.
gboolean Query(GstPad* pad, GstObject* parent, GstQuery* query) {
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

/// A seek applies to clouds and samples.
gboolean Event(GstPad* pad, GstObject* parent, GstEvent* event) {
  if (GST_EVENT_TYPE(event) != GST_EVENT_SEEK) return gst_pad_event_default(pad, parent, event);
  return gst_pad_send_event(GST_BASE_SRC_PAD(parent), event);
}

/// The stream joins the group that the clouds are in.
GstEvent* StreamStart(GstPad* imu, GstElement* element, GstPad* clouds) {
  const StringPtr id(gst_pad_create_stream_id(imu, element, "imu"));
  GstEvent* event = gst_event_new_stream_start(id.get());
  const EventPtr start(gst_pad_get_sticky_event(clouds, GST_EVENT_STREAM_START, 0));
  guint group = 0;
  if (start && gst_event_parse_group_id(start.get(), &group)) gst_event_set_group_id(event, group);
  return event;
}

}  // namespace

ImuPad::ImuPad(GstElement* element) : element_(element) {
  gst_segment_init(&segment_, GST_FORMAT_TIME);
}

ImuPad::~ImuPad() {
  if (pad_ == nullptr) return;
  gst_pad_remove_probe(GST_BASE_SRC_PAD(element_), end_of_clouds_);
  gst_pad_set_active(pad_, FALSE);
  gst_element_remove_pad(element_, pad_);
}

void ImuPad::AddPad() {
  GstPadTemplate* pad_template =
      gst_element_class_get_pad_template(GST_ELEMENT_GET_CLASS(element_), "imu");
  GstPad* clouds = GST_BASE_SRC_PAD(element_);
  GstPad* pad = gst_pad_new_from_template(pad_template, "imu");
  gst_pad_use_fixed_caps(pad);
  gst_pad_set_query_function(pad, Query);
  gst_pad_set_event_function(pad, Event);
  gst_pad_set_active(pad, TRUE);
  {
    const std::lock_guard lock(mutex_);
    pad_ = pad;
  }
  gst_pad_push_event(pad_, StreamStart(pad_, element_, clouds));
  end_of_clouds_ = gst_pad_add_probe(clouds, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, EndWithClouds,
                                     gst_object_ref(pad_), gst_object_unref);
}

void ImuPad::SetCaps(const ouster::Metadata& metadata) {
  imu_to_sensor_ = metadata.imu_to_sensor;
  const CapsPtr caps(MakeCaps(metadata));
  gst_pad_push_event(pad_, gst_event_new_caps(caps.get()));
}

/// The events come before the pad: a handler that links it in its signal finds them there.
void ImuPad::Prepare(const ouster::Metadata& metadata) {
  const bool first = pad_ == nullptr;
  if (first) AddPad();
  if (first || imu_to_sensor_ != metadata.imu_to_sensor) SetCaps(metadata);
  if (std::exchange(segment_pending_, false))
    gst_pad_push_event(pad_, gst_event_new_segment(&segment_));
  if (first) gst_element_add_pad(element_, pad_);
}

void ImuPad::SetSegment(const GstSegment& segment) {
  segment_ = segment;
  segment_pending_ = true;
  last_pts_ = 0;
}

/// A reference to the pad, or null if there is none yet.
GstPad* ImuPad::StartOrStopFlush(bool flushing) {
  const std::lock_guard lock(mutex_);
  flushing_ = flushing;
  return pad_ != nullptr ? GST_PAD(gst_object_ref(pad_)) : nullptr;
}

void ImuPad::StartFlush(guint32 seqnum) {
  const std::unique_ptr<GstPad, Unref> pad(StartOrStopFlush(true));
  if (!pad) return;
  GstEvent* event = gst_event_new_flush_start();
  gst_event_set_seqnum(event, seqnum);
  gst_pad_push_event(pad.get(), event);
}

void ImuPad::StopFlush(guint32 seqnum) {
  const std::unique_ptr<GstPad, Unref> pad(StartOrStopFlush(false));
  if (!pad) return;
  GstEvent* event = gst_event_new_flush_stop(TRUE);
  gst_event_set_seqnum(event, seqnum);
  gst_pad_push_event(pad.get(), event);
}

void ImuPad::Push(ByteView packet, const ouster::SensorStream& stream) {
  const auto samples = ouster::ParseImuPacket(packet, stream.metadata());
  if (!samples || samples->empty()) return;
  const GstClockTime start = ToClockTime(stream.LocalOf(samples->front().timestamp));
  if (start < segment_.start) return;
  {
    const std::lock_guard lock(mutex_);
    if (flushing_) return;
  }
  Prepare(stream.metadata());
  std::vector<std::uint8_t> bytes;
  bytes.reserve(samples->size() * kSampleSize);
  ByteWriter w(&bytes);
  for (const ouster::ImuSample& s : *samples) {
    w.Le64(ToClockTime(stream.UtcOf(s.timestamp)));
    for (const float v : s.acceleration) w.LeF32(v);
    for (const float v : s.angular_velocity) w.LeF32(v);
  }
  GstBuffer* buffer = gst_buffer_new_memdup(bytes.data(), bytes.size());
  last_pts_ = std::max(last_pts_, start);
  GST_BUFFER_PTS(buffer) = last_pts_;
  gst_lidar_buffer_set_capture_time(buffer, ToClockTime(stream.UtcOf(samples->front().timestamp)));
  const GstFlowReturn flow = gst_pad_push(pad_, buffer);
  if (flow != GST_FLOW_OK)
    GST_LOG_OBJECT(pad_, "a packet was not taken: %s", gst_flow_get_name(flow));
}

}  // namespace lidar::gst
