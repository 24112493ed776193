// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether anybody answers what screamtx sends.
#pragma once
#include <optional>

#include "src/base/time.h"

namespace lidar::gst {

class FeedbackWatch {
 public:
  /// Packets that nobody answers for so long mean that nobody listens.
  static constexpr Duration kPatience = std::chrono::seconds(2);

  void OnSent(Time now) {
    if (!unanswered_since_) unanswered_since_ = now;
    OnInput(now);
  }
  /// There is more to send: without that, silence means nothing.
  void OnInput(Time now) {
    if (unanswered_since_ && now - *unanswered_since_ >= kPatience) silent_ = true;
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
