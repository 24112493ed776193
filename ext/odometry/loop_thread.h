// SPDX-License-Identifier: LGPL-2.1-or-later
// Looks for loops beside the streaming thread.
#pragma once
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "src/slam/loop_closer.h"

namespace lidar::gst {

/// Safe for any thread.
class LoopThread {
 public:
  explicit LoopThread(const slam::LoopSettings& settings);
  ~LoopThread();
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  /// Takes a scan of the sensor's frame, and its pose by the odometry. Returns at once. A scan that
  /// finds kMostWaiting others is dropped.
  void AddScan(const odometry::StampedPose& pose, const odometry::Points& points);
  /// Returns when all scans were looked at, and the last local map was ended.
  void Finish();

  struct Progress {
    odometry::Pose map_from_odometry;
    std::size_t solved = 0;  // how often loops were closed
    std::size_t loops = 0;   // between the local maps that are kept
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

  mutable std::mutex mutex_;  // guards all but the closer
  std::condition_variable changed_;
  std::deque<WaitingScan> waiting_;
  bool busy_ = false;
  bool stop_ = false;
  Progress progress_;
  slam::LoopCloser closer_;  // of the thread; of Finish() while the thread has nothing to do
  std::thread thread_;
};

}  // namespace lidar::gst
