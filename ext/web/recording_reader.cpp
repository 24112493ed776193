// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/recording_reader.h"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

namespace lidar::web {

struct RecordingReader::DoneSource {
  GSource source;
  RecordingReader* reader;
};

RecordingReader::RecordingReader(OnPiece on_piece) : on_piece_(std::move(on_piece)) {
  static GSourceFuncs functions{nullptr, nullptr, OnDone, nullptr, nullptr, nullptr};
  done_source_.reset(g_source_new(&functions, sizeof(DoneSource)));
  reinterpret_cast<DoneSource*>(done_source_.get())->reader = this;
  g_source_attach(done_source_.get(), g_main_context_get_thread_default());
}

RecordingReader::~RecordingReader() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    if (current_) current_->Cancel();
  }
  change_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void RecordingReader::Ask(Job job) {
  const std::lock_guard lock(mutex_);
  const auto same = std::find_if(jobs_.begin(), jobs_.end(), [&job](const Job& other) {
    return other.asker == job.asker && other.recording == job.recording;
  });
  if (same != jobs_.end())
    *same = std::move(job);
  else
    jobs_.push_back(std::move(job));
  change_.notify_one();
  if (thread_.joinable()) return;
  try {
    thread_ = std::thread([this] { Run(); });
  } catch (const std::system_error&) {
    jobs_.clear();  // the viewer may send its request again
  }
}

void RecordingReader::Forget(std::uint64_t asker) {
  const std::lock_guard lock(mutex_);
  const auto gone = std::remove_if(jobs_.begin(), jobs_.end(),
                                   [asker](const Job& job) { return job.asker == asker; });
  jobs_.erase(gone, jobs_.end());
}

/// Runs the jobs. The thread pauses after each job for as long as the job took. Viewers that jump
/// all the time therefore use at most half a core.
void RecordingReader::Run() {
  using Clock = std::chrono::steady_clock;
  pthread_setname_np(pthread_self(), "foxglove-replay");
  std::unique_lock lock(mutex_);
  for (;;) {
    change_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
    if (stopping_) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    current_ = job.recording;
    lock.unlock();
    const auto began = Clock::now();
    Recording::Piece piece = job.kind == Kind::kLook   ? job.recording->Look()
                             : job.kind == Kind::kJump ? job.recording->Jump(job.at)
                                                       : job.recording->GoOn(job.at);
    const auto spent = Clock::now() - began;
    lock.lock();
    current_.reset();
    done_.emplace_back(std::move(job), std::move(piece));
    g_source_set_ready_time(done_source_.get(), 0);
    change_.wait_for(lock, spent, [this] { return stopping_; });
  }
}

gboolean RecordingReader::OnDone(GSource* source, GSourceFunc, gpointer) {
  g_source_set_ready_time(source, -1);
  reinterpret_cast<DoneSource*>(source)->reader->TakeDone();
  return G_SOURCE_CONTINUE;
}

void RecordingReader::TakeDone() {
  std::deque<std::pair<Job, Recording::Piece>> done;
  {
    const std::lock_guard lock(mutex_);
    done.swap(done_);
  }
  for (const auto& [job, piece] : done) on_piece_(job, piece);
}

}  // namespace lidar::web
