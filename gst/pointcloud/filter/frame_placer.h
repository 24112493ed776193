// SPDX-License-Identifier: LGPL-2.1-or-later
// Places clouds into a frame by the transforms of an inbox, and counts clouds without a transform.
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
  /// For any thread.
  TransformInbox& inbox() { return inbox_; }
  guint64 clouds_without() const { return without_; }

  // For the streaming thread.

  /// Sets the frame of output clouds; empty: clouds keep their frame.
  void SetTarget(std::string target, std::chrono::nanoseconds patience);
  /// Finds the transform of a cloud of `frame` to the target. If there is none, it sets `transform`
  /// to nothing, counts the cloud, and warns for `element` if the previous cloud had a transform.
  /// Returns FLUSHING if a flush or the end of the stream ended the wait.
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
