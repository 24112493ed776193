// SPDX-License-Identifier: LGPL-2.1-or-later
// Detects that screamtx gets no answer.
#pragma once
#include <optional>

#include "src/base/time.h"

namespace lidar::gst {

class FeedbackWatch {
 public:
  /// Packets unanswered for this time show that there is no receiver.
  static constexpr Duration kFeedbackTimeout = std::chrono::seconds(2);
  /// Shorter limit at the end of a stream that was never answered.
  static constexpr Duration kFirstAnswer = std::chrono::milliseconds(300);

  void OnSent(Time now) {
    if (!unanswered_since_) unanswered_since_ = now;
    OnInput(now);
  }
  /// Call it for each input: without input, missing feedback is not silence of the receiver.
  void OnInput(Time now) {
    if (unanswered_since_ && now - *unanswered_since_ >= kFeedbackTimeout) silent_ = true;
  }
  void OnFeedback() {
    unanswered_since_.reset();
    silent_ = false;
    heard_ = true;
  }
  bool silent() const { return silent_; }
  /// Returns true at the end of a stream without a receiver.
  bool EndsUnheard(Time now) const {
    return !heard_ && unanswered_since_ && now - *unanswered_since_ >= kFirstAnswer;
  }

 private:
  std::optional<Time> unanswered_since_;
  bool silent_ = false;
  bool heard_ = false;
};

}  // namespace lidar::gst
