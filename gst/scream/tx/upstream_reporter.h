// SPDX-License-Identifier: LGPL-2.1-or-later
// What screamtx tells: target-bitrate and key units upstream, messages and the estimate to the
// application.
#pragma once
#include <gst/gst.h>

#include <condition_variable>
#include <vector>

#include "gst/common/refs.h"
#include "gst/scream/tx/feedback_watch.h"
#include "gst/scream/tx/gstscreamtx.h"
#include "gst/scream/tx/stream.h"
#include "src/scream/statistics.h"
#include "src/scream/target_notifier.h"

namespace lidar::gst {

struct TxState;

/// Whoever changes what the controller knows calls Evaluate(), which finds out what is due; a
/// thread of its own sends it. Start() and Stop() are called without the element's lock, the rest
/// with it. The thread sends without it.
class UpstreamReporter {
 public:
  explicit UpstreamReporter(GstLidarScreamTx* self) : self_(self) {}

  /// False after an element error where the system has no thread for it.
  bool Start();
  void Stop();

  /// For a new controller.
  void Reset(Time now);
  void OnSent(Time now) { watch_.OnSent(now); }
  void OnInput(Time now) { watch_.OnInput(now); }
  void OnFeedback() { watch_.OnFeedback(); }
  /// Finds out what is due.
  void Evaluate(Time now);
  /// When to call Evaluate() again, whatever happens.
  Time NextLook(Time now) const;
  /// The first target of `stream`, once.
  EventPtr FirstTarget(TxStream& stream, Time now);
  guint estimated_bps() const { return estimated_bps_; }

 private:
  struct PadEvent {
    PadPtr pad;
    EventPtr event;
    bool is_target = false;
  };
  struct Work {
    std::vector<PadEvent> events;
    std::vector<MessagePtr> messages;
    bool notify = false;
    bool warn_of_silence = false;
    bool warn_of_unheeded = false;
  };
  void Run();
  void Send(Work work);
  bool EvaluateStream(TxStream& stream, Time now);
  bool EvaluateEstimate(Time now);
  bool HasWork() const;
  Work TakeWork(Time now);
  MessagePtr EcnMessage();
  MessagePtr FeedbackMessage();
  void WarnOfSilence();
  void WarnOfUnheeded();
  EventPtr TargetEvent(const TxStream& stream, Time now, const char* reason) const;
  TxState& state() const;

  GstLidarScreamTx* self_;
  GThread* thread_ = nullptr;  // of those who call Start() and Stop()
  std::condition_variable due_;
  bool stop_ = false;
  bool estimate_due_ = false;
  bool stats_due_ = false;
  scream::TargetNotifier notifier_;
  scream::EcnState ecn_state_ = scream::EcnState::kOff;
  scream::EcnState ecn_announced_ = scream::EcnState::kOff;
  guint estimated_bps_ = 0;
  Time next_stats_{};
  FeedbackWatch watch_;
  bool silence_announced_ = false;
  bool warned_of_silence_ = false;
  bool warned_of_unheeded_ = false;
  bool unheeded_ = false;  // a target that nobody upstream took
};

}  // namespace lidar::gst
