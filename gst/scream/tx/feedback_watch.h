// SPDX-License-Identifier: LGPL-2.1-or-later
// Detects that screamtx gets no feedback.
#pragma once
#include <optional>

#include "src/base/time.h"

namespace lidar::gst {

class FeedbackWatch {
 public:
  /// If sent packets get no feedback for this time, there is no receiver.
  static constexpr Duration kFeedbackTimeout = std::chrono::seconds(2);
  /// The shorter limit that applies at the end of a stream that never got feedback.
  static constexpr Duration kFirstAnswer = std::chrono::milliseconds(300);

  void OnSent(Time now) {
    if (!unanswered_since_) unanswered_since_ = now;
    OnInput(now);
  }
  /// Call it for each input packet. Missing feedback counts as silence only while there is input,
  /// because without input there are no packets to acknowledge.
  void OnInput(Time now) {
    if (unanswered_since_ && now - *unanswered_since_ >= kFeedbackTimeout) silent_ = true;
  }
  void OnFeedback() {
    unanswered_since_.reset();
    silent_ = false;
    heard_ = true;
  }
  bool silent() const { return silent_; }
  /// Call it at the end of the stream. Returns true if no feedback ever arrived, although the first
  /// packet was sent at least kFirstAnswer ago.
  bool EndsUnheard(Time now) const {
    return !heard_ && unanswered_since_ && now - *unanswered_since_ >= kFirstAnswer;
  }

 private:
  std::optional<Time> unanswered_since_;
  bool silent_ = false;
  bool heard_ = false;
};

}  // namespace lidar::gst
