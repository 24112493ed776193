// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the transforms that move clouds to a target frame, and counts clouds without a transform.
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>

#include "gst/pointcloud/filter/transform_inbox.h"

namespace lidar::gst {

class FramePlacer {
 public:
  /// Any thread may call these two methods.
  TransformInbox& inbox() { return inbox_; }
  guint64 clouds_without() const { return without_; }

  // Only the streaming thread may call the methods below.

  /// Sets the frame to which clouds are moved. If `target` is empty, clouds keep their frame. A
  /// cloud waits for its transform at most for `patience`.
  void SetTarget(std::string target, std::chrono::nanoseconds patience);
  /// Finds the transform that moves a cloud from `frame` to the target frame. If there is none,
  /// sets `transform` to nothing, counts the cloud, and posts a warning unless the cloud before it
  /// had none either. Returns FLUSHING if the wait was interrupted, because of a flush or because
  /// the element stops.
  GstFlowReturn Place(GstElement* element, GstBuffer* cloud, const std::string& frame,
                      std::optional<Transform>* transform);
  void Clear();

 private:
  void Note(GstElement* element, const std::string& frame, const TransformTree::Answer& answer);

  TransformInbox inbox_;
  std::string target_;
  std::chrono::nanoseconds patience_{};
  bool reported_ = false;
  std::atomic<guint64> without_{0};
};

}  // namespace lidar::gst
