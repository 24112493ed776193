// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/filter/frame_placer.h"

#include <utility>

#include "gst/common/coordinate_frames.h"

namespace lidar::gst {

void FramePlacer::SetTarget(std::string target, std::chrono::nanoseconds patience) {
  target_ = std::move(target);
  patience_ = patience;
}

GstFlowReturn FramePlacer::Place(GstElement* element, GstBuffer* cloud, const std::string& frame,
                                 std::optional<Transform>* transform) {
  *transform = kIdentity;
  if (target_.empty()) return GST_FLOW_OK;
  const std::string source = frame.empty() ? kCloudFrame : frame;
  const auto answer = inbox_.Find(target_, source, CaptureTimeOf(cloud), patience_);
  *transform = answer.transform;
  if (!answer.transform && inbox_.is_interrupted()) return GST_FLOW_FLUSHING;
  Note(element, source, answer);
  return GST_FLOW_OK;
}

void FramePlacer::Note(GstElement* element, const std::string& frame,
                       const TransformTree::Answer& answer) {
  const bool reported = std::exchange(reported_, !answer.transform);
  if (answer.transform) return;
  ++without_;
  if (reported) return;
  GST_ELEMENT_WARNING(element, STREAM, FAILED,
                      ("A cloud of the frame %s cannot be transformed into the frame %s: %s. Such "
                       "clouds are dropped and counted.",
                       frame.c_str(), target_.c_str(), answer.why.c_str()),
                      (nullptr));
}

void FramePlacer::Clear() {
  reported_ = false;
  without_ = 0;
  inbox_.Clear();
}

}  // namespace lidar::gst
