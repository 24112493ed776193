// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads recordings in a thread of its own, so that a slow disk does not delay live streams.
#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "ext/web/glib_ptr.h"
#include "ext/web/recording.h"

namespace lidar::web {

/// Runs jobs for the server's thread. It may be used only in that thread, whose default context
/// must run.
class RecordingReader {
 public:
  enum class Kind { kLook, kJump, kGoOn };
  struct Job {
    std::uint64_t asker = 0;  // an id that the caller chooses
    std::shared_ptr<Recording> recording;
    Kind kind = Kind::kLook;
    std::uint64_t at = 0;  // time [ns] for kJump, position for kGoOn
  };
  using OnPiece = std::function<void(const Job& job, const Recording::Piece& piece)>;

  /// `on_piece` is called in the server's thread.
  explicit RecordingReader(OnPiece on_piece);
  ~RecordingReader();
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;

  /// Queues a job. Replaces a queued job of the same asker and recording.
  void Ask(Job job);
  /// Drops the queued jobs of the asker.
  void Forget(std::uint64_t asker);

 private:
  static gboolean OnDone(GSource* source, GSourceFunc, gpointer);
  struct DoneSource;
  void Run();
  void TakeDone();

  const OnPiece on_piece_;
  SourcePtr done_source_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable change_;
  std::deque<Job> jobs_;
  std::deque<std::pair<Job, Recording::Piece>> done_;
  std::shared_ptr<Recording> current_;
  bool stopping_ = false;
  std::thread thread_;  // started with the first job
};

}  // namespace lidar::web
