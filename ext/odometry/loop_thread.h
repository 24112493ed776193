// SPDX-License-Identifier: LGPL-2.1-or-later
// Searches scans for loops in a thread of its own.
#pragma once
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "src/slam/loop_closer.h"

namespace lidar::gst {

/// Any thread may call it.
class LoopThread {
 public:
  explicit LoopThread(const slam::LoopSettings& settings);
  ~LoopThread();
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  /// Queues a scan, in the sensor's frame, with its pose from the odometry. Returns at once. Drops
  /// the scan if kMostWaiting others wait.
  void AddScan(const odometry::StampedPose& pose, const odometry::Points& points);
  /// Returns when all scans were searched and the last local map has ended.
  void Finish();

  struct Progress {
    odometry::Pose map_from_odometry;
    std::size_t solved = 0;  // number of times that the pose graph was solved
    std::size_t loops = 0;   // number of loops between the local maps that are kept
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

  mutable std::mutex mutex_;  // guards all members but closer_
  std::condition_variable changed_;
  std::deque<WaitingScan> waiting_;
  bool busy_ = false;
  bool stop_ = false;
  Progress progress_;
  slam::LoopCloser closer_;  // used by the thread; by Finish() while the thread is idle
  std::thread thread_;
};

}  // namespace lidar::gst
