// SPDX-License-Identifier: LGPL-2.1-or-later
// Searches scans for loops in a separate thread.
#pragma once
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "src/slam/loop_closer.h"

namespace lidar::gst {

/// A loop closer with a thread and a queue of scans. Any thread may call the methods.
class LoopThread {
 public:
  explicit LoopThread(const slam::LoopSettings& settings);
  ~LoopThread();
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  /// Adds a scan to the queue and returns at once. `points` are in the sensor's frame, and `pose`
  /// comes from the odometry. If kMostWaiting scans are waiting already, the scan is dropped.
  void AddScan(const odometry::StampedPose& pose, const odometry::Points& points);
  /// Waits until all scans have been searched, and ends the last local map.
  void Finish();

  struct Progress {
    odometry::Pose map_from_odometry;
    std::size_t solved = 0;  // how many times the pose graph was solved
    std::size_t loops = 0;   // number of loops between local maps that are still stored
    std::size_t local_maps = 0;
    std::size_t scans_dropped = 0;
  };
  Progress progress() const;

  static constexpr std::size_t kMostWaiting = 100;  // scans

 private:
  struct WaitingScan {
    odometry::StampedPose pose;
    odometry::Points points;
  };
  void Run();
  void Publish();

  mutable std::mutex mutex_;  // guards all members except closer_
  std::condition_variable changed_;
  std::deque<WaitingScan> waiting_;
  bool busy_ = false;
  bool stop_ = false;
  Progress progress_;
  // Used by the thread, and by Finish() while the thread is idle.
  slam::LoopCloser closer_;
  std::thread thread_;
};

}  // namespace lidar::gst
