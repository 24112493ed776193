// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/odometry/side_pads.h"

#include "ext/odometry/pose_output.h"
#include "gst/common/buffer_map.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"

namespace lidar::gst {
namespace {

ImuInput& InputOf(GstPad* pad) { return *static_cast<ImuInput*>(gst_pad_get_element_private(pad)); }

GstFlowReturn ImuChain(GstPad* pad, GstObject*, GstBuffer* buffer) {
  const BufferPtr owned(buffer);
  const BufferMap map(buffer, GST_MAP_READ);
  if (!map || !InputOf(pad).Add(map.view()))
    GST_WARNING_OBJECT(pad, "dropping a buffer of IMU samples that does not match its caps");
  return GST_FLOW_OK;
}

/// Handles the caps of the IMU. All events are dropped here, because the element does not forward
/// the samples.
gboolean ImuEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  const EventPtr owned(event);
  if (GST_EVENT_TYPE(event) != GST_EVENT_CAPS) return TRUE;
  GstCaps* caps = nullptr;
  gst_event_parse_caps(event, &caps);
  if (InputOf(pad).SetCaps(caps)) return TRUE;
  GST_ELEMENT_ERROR(
      parent, STREAM, FORMAT,
      ("The caps do not describe IMU samples in the format of ouster_src, ros2src and mcapsrc."),
      ("%" GST_PTR_FORMAT, static_cast<gpointer>(caps)));
  return FALSE;
}

/// Copies a sticky event from the pad odometry to the pad map, because the pad map may be requested
/// after the event.
gboolean CopyToMap(GstPad*, GstEvent** event, gpointer map) {
  const bool caps = GST_EVENT_TYPE(*event) == GST_EVENT_CAPS;
  const EventPtr copy(caps ? gst_event_new_caps(MapCaps().get()) : gst_event_ref(*event));
  gst_pad_store_sticky_event(GST_PAD(map), copy.get());
  return TRUE;
}

PadPtr PadOf(GstElement* element, const char* name) {
  return PadPtr(gst_element_get_static_pad(element, name));
}

}  // namespace

GstPad* AddSidePad(GstElement* element, GstPadTemplate* pad_template, ImuInput* imu) {
  const gchar* name = GST_PAD_TEMPLATE_NAME_TEMPLATE(pad_template);
  if (PadOf(element, name)) return nullptr;
  GstPad* pad = gst_pad_new_from_template(pad_template, name);
  if (GST_PAD_IS_SINK(pad)) {
    gst_pad_set_element_private(pad, imu);
    gst_pad_set_chain_function(pad, ImuChain);
    gst_pad_set_event_function(pad, ImuEvent);
  } else {
    gst_pad_use_fixed_caps(pad);
    gst_pad_set_active(pad, TRUE);
    gst_pad_sticky_events_foreach(PadOf(element, "odometry").get(), CopyToMap, pad);
  }
  gst_element_add_pad(element, pad);
  return pad;
}

void PushPose(GstElement* element, const odometry::Estimate& estimate, GstClockTime pts) {
  const PadPtr poses = PadOf(element, "odometry");
  if (gst_pad_is_linked(poses.get())) gst_pad_push(poses.get(), PoseBuffer(estimate, pts));
}

void PushMap(GstElement* element, const odometry::Pose& map_from_odometry, Time time,
             GstClockTime pts) {
  const PadPtr map = PadOf(element, "map");
  if (map && gst_pad_is_linked(map.get()))
    gst_pad_push(map.get(), MapBuffer(map_from_odometry, time, pts));
}

void PushToPoses(GstElement* element, GstEvent* event) {
  const auto push = [event](GstPad* pad, const CapsPtr& caps) {
    gst_pad_push_event(pad, gst_event_ref(event));
    if (GST_EVENT_TYPE(event) == GST_EVENT_STREAM_START)
      gst_pad_push_event(pad, gst_event_new_caps(caps.get()));
  };
  push(PadOf(element, "odometry").get(),
       CapsPtr(gst_caps_new_empty_simple(GST_LIDAR_ODOMETRY_MEDIA_TYPE)));
  const PadPtr map = PadOf(element, "map");
  if (map) push(map.get(), MapCaps());
}

}  // namespace lidar::gst
