// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages of screamtx to the application: the estimate, changes of ECN and feedback, warnings.
#pragma once
#include <gst/gst.h>

#include <utility>
#include <vector>

#include "gst/common/refs.h"
#include "gst/scream/tx/feedback_watch.h"
#include "src/base/target_notifier.h"
#include "src/scream/controller.h"

namespace lidar::gst {

/// Call its methods with the element's lock held, except Post() and PostUnheard().
class Notices {
 public:
  /// Messages to post after the lock is released.
  struct Batch {
    std::vector<MessagePtr> messages;
    bool estimate = false;
    bool stats = false;  // the caller adds the message
    bool silence = false;
    bool unheeded = false;
  };

  /// Resets the state for a new controller.
  void Reset(const scream::Controller& controller, Time now);
  FeedbackWatch& watch() { return watch_; }
  /// Notes that no encoder has handled a target-bitrate event.
  void OnUnheeded() { unheeded_ = true; }
  guint estimated_bps() const { return estimated_bps_; }

  /// Compares the controller's state with the last messages. Returns true if a message is due.
  bool Evaluate(const scream::Controller& controller, Duration stats_interval, Time now);
  bool due() const;
  /// Returns the messages that are due. `most_dropped` is the highest number of dropped frames of
  /// any stream.
  Batch Take(GstObject* element, guint64 most_dropped);
  /// Returns the time at which Evaluate() finds that statistics are due.
  Time next_stats() const { return next_stats_; }

  static void Post(GstElement* element, GstPad* src, Batch batch);
  /// Call it at the end of the stream. Returns true if the caller must warn, by PostUnheard(), that
  /// there was no receiver.
  bool TakeUnheard(Time now) { return warn_of_silence_(watch_.EndsUnheard(now)); }
  /// Warns that there was no receiver. Call it before the EOS event is pushed.
  static void PostUnheard(GstElement* element, GstPad* src);

 private:
  /// A condition that is true at most once. It guards a warning that is posted once.
  class Once {
   public:
    bool operator()(bool wanted) { return wanted && !std::exchange(done_, true); }

   private:
    bool done_ = false;
  };
  MessagePtr EcnMessage(GstObject* element);
  MessagePtr FeedbackMessage(GstObject* element);

  TargetNotifier notifier_;
  guint estimated_bps_ = 0;
  bool estimate_due_ = false;
  Time next_stats_{};
  bool stats_due_ = false;
  scream::EcnState ecn_ = scream::EcnState::kOff;
  scream::EcnState ecn_posted_ = scream::EcnState::kOff;
  FeedbackWatch watch_;
  bool silence_posted_ = false;
  bool unheeded_ = false;
  Once warn_of_silence_;
  Once warn_of_unheeded_;
};

}  // namespace lidar::gst
