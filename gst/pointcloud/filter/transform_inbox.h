// SPDX-License-Identifier: LGPL-2.1-or-later
// An element's pads for transforms, and the transforms that arrived.
#pragma once
#include <gst/gst.h>

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "src/cloud/transform_tree.h"

namespace lidar::gst {

/// Returns nothing if the buffer has no capture time. Differences of these times do not overflow.
std::optional<Time> CaptureTimeOf(GstBuffer* buffer);

/// All threads may call it.
class TransformInbox {
 public:
  /// Adds a sink pad of `pad_template` that takes TFMessages and odometry. The inbox must outlive
  /// the pad.
  GstPad* AddPad(GstElement* element, GstPadTemplate* pad_template, const gchar* name);
  void ReleasePad(GstElement* element, GstPad* pad);

  /// Finds the transform of points from `source` to `target`. Waits for a missing transform. After
  /// a wait without success, it waits again only when a newer transform has come.
  TransformTree::Answer Find(const std::string& target, const std::string& source,
                             std::optional<Time> at, std::chrono::nanoseconds timeout);
  /// Ends waits of Find(), until Interrupt(false).
  void Interrupt(bool on);
  bool is_interrupted() const;
  void Clear();

  struct Counters {
    guint64 transforms = 0;
    guint64 refused = 0;  // invalid transforms and messages
  };
  Counters counters() const;

 private:
  static GstFlowReturn Chain(GstPad* pad, GstObject* parent, GstBuffer* buffer);
  static gboolean Event(GstPad* pad, GstObject* parent, GstEvent* event);
  void TakeMessage(const GstStructure* caps, GstBuffer* buffer);
  void TakePose(const GstStructure* caps, GstBuffer* buffer);
  void Note(const std::string& parent, const std::string& child, Time at, const FramePose& pose,
            bool for_good);
  void Refuse();
  void SetEnded(GstPad* pad, bool ended);
  bool MayCome(const TransformTree::Answer& answer) const;

  mutable std::mutex mutex_;  // guards all that follows
  std::condition_variable changed_;
  TransformTree tree_;
  Counters counters_;
  std::map<GstPad*, bool> pads_;  // true: ended
  bool interrupted_ = false;
  std::optional<Time> waited_in_vain_;  // time of the newest transform at the last vain wait
};

}  // namespace lidar::gst
