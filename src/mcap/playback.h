// SPDX-License-Identifier: LGPL-2.1-or-later
// The files of a recording, read as one.
#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "src/mcap/file_names.h"
#include "src/mcap/reader.h"

namespace lidar::mcap {

class Playback {
 public:
  struct Topic {
    Schema schema;
    Channel channel;
  };
  /// `message` is valid until the next call of Next() or Seek().
  struct Item {
    const Schema* schema = nullptr;
    const Channel* channel = nullptr;
    Message message;
  };

  /// Opens the files that `location` names, which may have a number. Returns nothing if no file can
  /// be read; `why` then has the reason for a user. Reading ends once `cancelled`, which outlives
  /// the playback, is true.
  static std::unique_ptr<Playback> Open(const std::string& location,
                                        const std::atomic<bool>* cancelled, std::string* why);

  /// Lists the files again, because a recording that is still written grows and loses its oldest
  /// files. Returns false if there is no file to read; `why` then has the reason. Call Seek() next.
  bool Refresh(std::string* why);

  /// Log times [ns].
  std::uint64_t start_time() const { return start_time_; }
  std::uint64_t end_time() const { return end_time_; }
  /// The first channel of each topic, known before any message is read.
  const std::vector<Topic>& topics() const { return topics_; }
  /// Numbers of files without an index, and of unreadable files. A file that becomes unreadable
  /// before its turn counts, too.
  std::uint64_t unclosed_files() const { return unclosed_files_; }
  std::uint64_t unreadable_files() const { return unreadable_files_; }
  /// The reason why the last such file could not be read at its turn.
  const std::string& why_unreadable() const { return why_unreadable_; }
  /// Chunks that were left out so far.
  std::uint64_t damaged_chunks() const;

  /// Makes Next() return the messages with log times from `begin` to before `end`. Files may
  /// overlap.
  void Seek(std::uint64_t begin, std::uint64_t end = UINT64_MAX);
  std::optional<Item> Next();

 private:
  Playback(FileNames names, const std::atomic<bool>* cancelled)
      : names_(std::move(names)), cancelled_(cancelled) {}
  struct File {
    std::string path;
    std::uintmax_t size = 0;
    std::filesystem::file_time_type written;
    std::uint64_t start_time = 0;
    std::uint64_t end_time = 0;
    bool complete = false;
    FileIndex known = {};  // of a file that is not complete
  };

  bool Read(File* file, std::string* why);
  void Learn(const FileIndex& index);
  bool OpenNextFile();

  const FileNames names_;
  const std::atomic<bool>* const cancelled_;
  std::vector<File> files_;
  std::set<std::string> topic_names_;
  std::vector<Topic> topics_;
  std::uint64_t start_time_ = 0;
  std::uint64_t end_time_ = 0;
  std::uint64_t unclosed_files_ = 0;
  std::uint64_t unreadable_files_ = 0;
  std::string why_unreadable_;
  // The range of log times to play, and the file to continue with.
  std::uint64_t begin_ = 0;
  std::uint64_t end_ = UINT64_MAX;
  std::size_t next_file_ = 0;
  std::unique_ptr<Reader> reader_;
  std::uint64_t damaged_before_ = 0;  // in files before the one that is open
};

}  // namespace lidar::mcap
