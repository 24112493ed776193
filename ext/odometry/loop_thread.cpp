// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/odometry/loop_thread.h"

#include <utility>

namespace lidar::gst {

LoopThread::LoopThread(const slam::LoopSettings& settings)
    : closer_(settings), thread_([this] { Run(); }) {}

LoopThread::~LoopThread() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LoopThread::AddScan(const odometry::StampedPose& pose, const odometry::Points& points) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kMostWaiting) {
      ++progress_.scans_dropped;
      return;
    }
    waiting_.push_back({pose, points});
  }
  changed_.notify_all();
}

void LoopThread::Finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && !busy_; });
  closer_.Finish();
  Publish();
}

LoopThread::Progress LoopThread::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

/// Copies the results of the loop closer to progress_. The caller must hold the mutex.
void LoopThread::Publish() {
  progress_.map_from_odometry = closer_.MapFromOdometry();
  progress_.solved = closer_.solved();
  progress_.loops = closer_.closures().size();
  progress_.local_maps = closer_.local_maps();
}

void LoopThread::Run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stop_ || !waiting_.empty(); });
    if (stop_) return;
    const WaitingScan scan = std::move(waiting_.front());
    waiting_.pop_front();
    busy_ = true;
    lock.unlock();
    closer_.AddScan(scan.pose, scan.points);
    lock.lock();
    busy_ = false;
    Publish();
    changed_.notify_all();
  }
}

}  // namespace lidar::gst
