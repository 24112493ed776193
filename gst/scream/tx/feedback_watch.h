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

  void OnSent(Time now) {
    if (!unanswered_since_) unanswered_since_ = now;
    OnInput(now);
  }
  /// Notes that there is more to send; otherwise silence means nothing.
  void OnInput(Time now) {
    if (unanswered_since_ && now - *unanswered_since_ >= kFeedbackTimeout) silent_ = true;
  }
  void OnFeedback() {
    unanswered_since_.reset();
    silent_ = false;
  }
  bool silent() const { return silent_; }

 private:
  std::optional<Time> unanswered_since_;
  bool silent_ = false;
};

}  // namespace lidar::gst
