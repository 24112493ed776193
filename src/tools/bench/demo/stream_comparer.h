// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares the sent clouds with the received clouds during a run.
#pragma once
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "src/tools/bench/demo/cloud_compare.h"
#include "src/tools/bench/demo/cloud_frame.h"

namespace lidar::demo {

/// Reads both pipes in threads of its own. At most kMaxPending sent slices wait for the received
/// ones. Slices that are older than these were skipped or lost.
class StreamComparer {
 public:
  StreamComparer(int sent_fd, int received_fd, double reach_m);
  /// Waits until both pipes have ended.
  ~StreamComparer();
  StreamComparer(const StreamComparer&) = delete;
  StreamComparer& operator=(const StreamComparer&) = delete;

  using Result = std::pair<SliceKey, Comparison>;
  /// Returns the results since the last call of Take().
  std::vector<Result> Take();
  /// Waits until both pipes have ended and all slices are compared.
  void Finish();

  static constexpr std::size_t kMaxPending = 512;

 private:
  void ReadSent();
  void ReadReceived();
  bool TakeSent(SliceKey key, Cloud* cloud);

  const int sent_fd_;
  const int received_fd_;
  const double reach_m_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::map<SliceKey, Cloud> pending_;
  bool sent_ended_ = false;
  std::vector<Result> results_;
  std::thread sent_thread_;
  std::thread received_thread_;
};

}  // namespace lidar::demo
