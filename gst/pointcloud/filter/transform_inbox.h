// SPDX-License-Identifier: LGPL-2.1-or-later
// Receives transforms on pads of an element and stores them.
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

/// Returns the buffer's capture time, or nothing if it has none. The time is limited so that the
/// difference of two times does not overflow.
std::optional<Time> CaptureTimeOf(GstBuffer* buffer);

/// The transforms that have arrived on the pads of an element. Any thread may call the methods.
class TransformInbox {
 public:
  /// Adds a sink pad that accepts TFMessages and odometry. The inbox must outlive the pad.
  GstPad* AddPad(GstElement* element, GstPadTemplate* pad_template, const gchar* name);
  void ReleasePad(GstElement* element, GstPad* pad);

  /// Finds the transform that moves points from `source` to `target`. If it is missing, waits for
  /// it. After a wait without success, further calls wait only if a newer transform has arrived
  /// since then.
  TransformTree::Answer Find(const std::string& target, const std::string& source,
                             std::optional<Time> at, std::chrono::nanoseconds timeout);
  /// Makes Find() return without waiting until Interrupt(false) is called.
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

  mutable std::mutex mutex_;  // guards all members below
  std::condition_variable changed_;
  TransformTree tree_;
  Counters counters_;
  std::map<GstPad*, bool> pads_;  // true if the pad has received EOS
  bool interrupted_ = false;
  // The time of the newest transform when Find() last waited without success.
  std::optional<Time> waited_in_vain_;
};

}  // namespace lidar::gst
