// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/filter/transform_inbox.h"

#include <algorithm>

#include "gst/common/buffer_map.h"
#include "gst/common/coordinate_frames.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/messages.h"
#include "src/cdr/motion_samples.h"

namespace lidar::gst {
namespace {

TransformInbox& InboxOf(GstPad* pad) {
  return *static_cast<TransformInbox*>(gst_pad_get_element_private(pad));
}

}  // namespace

std::optional<Time> CaptureTimeOf(GstBuffer* buffer) {
  const GstClockTime captured = gst_lidar_buffer_get_capture_time(buffer);
  if (!GST_CLOCK_TIME_IS_VALID(captured)) return std::nullopt;
  const auto ns = std::min<GstClockTime>(captured, G_MAXINT64 / 2);
  return Time{} + Duration{static_cast<std::int64_t>(ns)};
}

GstPad* TransformInbox::AddPad(GstElement* element, GstPadTemplate* pad_template,
                               const gchar* name) {
  GstPad* pad = gst_pad_new_from_template(pad_template, name);
  gst_pad_set_element_private(pad, this);
  gst_pad_set_chain_function(pad, Chain);
  gst_pad_set_event_function(pad, Event);
  {
    const std::lock_guard lock(mutex_);
    pads_[pad] = false;
  }
  gst_pad_set_active(pad, TRUE);
  gst_element_add_pad(element, pad);
  return pad;
}

void TransformInbox::ReleasePad(GstElement* element, GstPad* pad) {
  gst_pad_set_active(pad, FALSE);
  {
    const std::lock_guard lock(mutex_);
    pads_.erase(pad);
  }
  changed_.notify_all();
  gst_element_remove_pad(element, pad);
}

GstFlowReturn TransformInbox::Chain(GstPad* pad, GstObject*, GstBuffer* raw) {
  const BufferPtr buffer(raw);
  const CapsPtr caps(gst_pad_get_current_caps(pad));
  if (!caps) return GST_FLOW_NOT_NEGOTIATED;
  const GstStructure* s = gst_caps_get_structure(caps.get(), 0);
  TransformInbox& inbox = InboxOf(pad);
  if (gst_structure_has_name(s, GST_LIDAR_TF_MEDIA_TYPE))
    inbox.TakeMessage(s, raw);
  else
    inbox.TakePose(s, raw);
  inbox.changed_.notify_all();
  return GST_FLOW_OK;
}

/// Handles events of a transform pad. They are not forwarded, because downstream has only the
/// stream of clouds.
gboolean TransformInbox::Event(GstPad* pad, GstObject*, GstEvent* event) {
  const EventPtr owner(event);
  if (GST_EVENT_TYPE(event) == GST_EVENT_EOS) InboxOf(pad).SetEnded(pad, true);
  if (GST_EVENT_TYPE(event) == GST_EVENT_STREAM_START ||
      GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP)
    InboxOf(pad).SetEnded(pad, false);
  return TRUE;
}

/// Reads a tf2_msgs/msg/TFMessage from ros2src.
void TransformInbox::TakeMessage(const GstStructure* caps, GstBuffer* buffer) {
  const BufferMap map(buffer, GST_MAP_READ);
  const auto transforms = map ? cdr::ReadTransforms(map.view()) : std::nullopt;
  if (!transforms) return Refuse();
  gboolean for_good = FALSE;
  gst_structure_get_boolean(caps, GST_LIDAR_TF_STATIC, &for_good);
  for (const cdr::TransformStamped& t : *transforms)
    Note(t.header.frame_id, t.child_frame_id, t.header.stamp, {t.translation, t.rotation},
         for_good != FALSE);
}

/// Reads a pose from lidarodometry or ros2src.
void TransformInbox::TakePose(const GstStructure* caps, GstBuffer* buffer) {
  const BufferMap map(buffer, GST_MAP_READ);
  const auto at = CaptureTimeOf(buffer);
  std::uint64_t tracking = 0;
  const auto read = map ? cdr::ReadPose(map.view(), &tracking) : std::nullopt;
  if (!read || !at) return Refuse();
  const FramePose pose{read->position, read->orientation};
  Note(FrameIn(caps, GST_LIDAR_FRAME_ID, kOdometryFrame),
       FrameIn(caps, GST_LIDAR_CHILD_FRAME_ID, kCloudFrame), *at, pose, false);
}

void TransformInbox::Note(const std::string& parent, const std::string& child, Time at,
                          const FramePose& pose, bool for_good) {
  const std::lock_guard lock(mutex_);
  ++(tree_.Set(parent, child, at, pose, for_good) ? counters_.transforms : counters_.refused);
}

void TransformInbox::Refuse() {
  const std::lock_guard lock(mutex_);
  ++counters_.refused;
}

void TransformInbox::SetEnded(GstPad* pad, bool ended) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = pads_.find(pad); known != pads_.end()) known->second = ended;
  }
  changed_.notify_all();
}

bool TransformInbox::MayCome(const TransformTree::Answer& answer) const {
  return answer.may_come && !interrupted_ && waited_in_vain_ != answer.newest &&
         std::any_of(pads_.begin(), pads_.end(), [](const auto& pad) { return !pad.second; });
}

TransformTree::Answer TransformInbox::Find(const std::string& target, const std::string& source,
                                           std::optional<Time> at,
                                           std::chrono::nanoseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  std::unique_lock lock(mutex_);
  auto answer = tree_.Find(target, source, at);
  while (!answer.transform && MayCome(answer)) {
    const bool late = changed_.wait_until(lock, deadline) == std::cv_status::timeout;
    answer = tree_.Find(target, source, at);
    if (!late || answer.transform) continue;
    waited_in_vain_ = answer.newest;
    return answer;
  }
  if (answer.transform) waited_in_vain_.reset();
  return answer;
}

void TransformInbox::Interrupt(bool on) {
  {
    const std::lock_guard lock(mutex_);
    interrupted_ = on;
  }
  changed_.notify_all();
}

bool TransformInbox::is_interrupted() const {
  const std::lock_guard lock(mutex_);
  return interrupted_;
}

void TransformInbox::Clear() {
  const std::lock_guard lock(mutex_);
  tree_ = {};
  counters_ = {};
  waited_in_vain_.reset();
  for (auto& pad : pads_) pad.second = false;
}

TransformInbox::Counters TransformInbox::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace lidar::gst
