// SPDX-License-Identifier: LGPL-2.1-or-later
// The thread of a source, which can pause and resume.
#pragma once
#include <gst/gst.h>

#include <mutex>

namespace lidar::gst {

/// The thread of a source. Changes of state start and stop the thread. Between them, the thread may
/// pause and resume. A paused thread cannot resume while another thread holds lock(). Any thread
/// may call the functions.
class PlayTask {
 public:
  PlayTask(GstTaskFunction loop, gpointer data) : task_(gst_task_new(loop, data, nullptr)) {
    g_rec_mutex_init(&lock_);
    gst_task_set_lock(task_, &lock_);
  }
  ~PlayTask() {
    gst_object_unref(task_);
    g_rec_mutex_clear(&lock_);
  }
  PlayTask(const PlayTask&) = delete;
  PlayTask& operator=(const PlayTask&) = delete;

  /// Returns false if no thread can be started.
  bool Start() { return Set(true, GST_TASK_STARTED); }
  void Stop() { Set(false, GST_TASK_STOPPED); }
  void Join() { gst_task_join(task_); }
  /// These two functions do nothing if the thread was stopped.
  void Pause() { SetIfRunning(GST_TASK_PAUSED); }
  void GoOn() { SetIfRunning(GST_TASK_STARTED); }

  GRecMutex* lock() { return &lock_; }

 private:
  bool Set(bool may_run, GstTaskState wanted) {
    const std::lock_guard lock(mutex_);
    may_run_ = may_run;
    return gst_task_set_state(task_, wanted) != FALSE;
  }
  void SetIfRunning(GstTaskState wanted) {
    const std::lock_guard lock(mutex_);
    if (may_run_) gst_task_set_state(task_, wanted);
  }

  GstTask* task_;
  GRecMutex lock_;
  std::mutex mutex_;
  bool may_run_ = false;
};

}  // namespace lidar::gst
