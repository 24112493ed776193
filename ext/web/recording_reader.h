// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads recordings in its own thread, so that a slow disk delays no live stream.
#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "ext/web/glib_ptr.h"
#include "ext/web/recording.h"

namespace lidar::web {

/// Used by the server's thread, with that thread's default context.
class RecordingReader {
 public:
  enum class Kind { kLook, kJump, kGoOn };
  struct Job {
    std::uint64_t asker = 0;  // id chosen by the caller
    std::shared_ptr<Recording> recording;
    Kind kind = Kind::kLook;
    std::uint64_t at = 0;  // time [ns] of kJump, position of kGoOn
  };
  using OnPiece = std::function<void(const Job& job, const Recording::Piece& piece)>;

  /// `on_piece` is called in the server's thread.
  explicit RecordingReader(OnPiece on_piece);
  ~RecordingReader();
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;

  /// Replaces a job of the same asker and recording that has not begun.
  void Ask(Job job);
  /// Drops the asker's jobs that have not begun.
  void Forget(std::uint64_t asker);

 private:
  static gboolean OnDone(GSource* source, GSourceFunc, gpointer);
  struct DoneSource;
  void Run();
  void TakeDone();

  const OnPiece on_piece_;
  SourcePtr done_source_;
  std::mutex mutex_;  // guards the following
  std::condition_variable change_;
  std::deque<Job> jobs_;
  std::deque<std::pair<Job, Recording::Piece>> done_;
  std::shared_ptr<Recording> current_;
  bool stopping_ = false;
  std::thread thread_;  // started by the first job
};

}  // namespace lidar::web
