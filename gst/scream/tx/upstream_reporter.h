// SPDX-License-Identifier: LGPL-2.1-or-later
// The thread of screamtx that sends targets to the encoders and notices to the application.
#pragma once
#include <gst/gst.h>

#include <condition_variable>
#include <vector>

#include "gst/scream/tx/gstscreamtx.h"
#include "gst/scream/tx/notices.h"
#include "gst/scream/tx/targets.h"

namespace lidar::gst {

struct TxState;

/// Call Evaluate() after each change of the controller's state. Evaluate() finds the events that
/// are due, and the reporter's thread sends them without the element's lock. Call Start() and
/// Stop() without the element's lock, and the other methods with it.
class UpstreamReporter {
 public:
  explicit UpstreamReporter(GstLidarScreamTx* self) : self_(self) {}

  /// Starts the thread. If the system cannot start a thread, posts an error message and returns
  /// false.
  bool Start();
  void Stop();

  Notices& notices() { return notices_; }
  /// Finds the events and messages that are due.
  void Evaluate(Time now);
  /// Returns the latest time at which Evaluate() must be called again.
  Time NextLook(Time now) const;

 private:
  struct Work {
    std::vector<PadEvent> events;
    Notices::Batch notices;
  };
  void Run();
  void Send(Work work);
  bool HasWork() const;
  Work TakeWork(Time now);
  TxState& state() const;

  GstLidarScreamTx* self_;
  GThread* thread_ = nullptr;  // used by the callers of Start() and Stop()
  std::condition_variable due_;
  bool stop_ = false;
  Notices notices_;
};

}  // namespace lidar::gst
