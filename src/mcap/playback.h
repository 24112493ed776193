// SPDX-License-Identifier: LGPL-2.1-or-later
// Plays all files of a recording as if they were a single file.
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
  /// A message with its channel. `message` is valid until the next call of Next() or Seek().
  struct Item {
    const Schema* schema = nullptr;
    const Channel* channel = nullptr;
    Message message;
  };

  /// Opens the files that `location` names. `location` may contain a number. Returns nothing and
  /// sets `why`, a text for users, if no file can be read. Reading ends as soon as `cancelled` is
  /// true. `cancelled` must outlive the playback.
  static std::unique_ptr<Playback> Open(const std::string& location,
                                        const std::atomic<bool>* cancelled, std::string* why);

  /// Lists the files again, because a recording that is still being written grows and loses its
  /// oldest files. Returns false and sets `why` if there is no file to read. Call Seek() before the
  /// next Next().
  bool Refresh(std::string* why);

  /// Return the range of log times [ns].
  std::uint64_t start_time() const { return start_time_; }
  std::uint64_t end_time() const { return end_time_; }
  /// Returns the first channel of each topic. The channels are known before any message is read.
  const std::vector<Topic>& topics() const { return topics_; }
  /// Return the numbers of files without an index, and of unreadable files. A file also counts as
  /// unreadable if it can no longer be read when playback reaches it.
  std::uint64_t unclosed_files() const { return unclosed_files_; }
  std::uint64_t unreadable_files() const { return unreadable_files_; }
  /// Returns the reason why playback could not read the last file that was unreadable when playback
  /// reached it.
  const std::string& why_unreadable() const { return why_unreadable_; }
  /// Returns the number of chunks that were skipped so far.
  std::uint64_t damaged_chunks() const;

  /// Makes Next() return the messages whose log times are at least `begin` and less than `end`. The
  /// times of the files may overlap.
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
    FileIndex known = {};  // index of an incomplete file
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
  // The range of log times to play, and the next file to open.
  std::uint64_t begin_ = 0;
  std::uint64_t end_ = UINT64_MAX;
  std::size_t next_file_ = 0;
  std::unique_ptr<Reader> reader_;
  std::uint64_t damaged_before_ = 0;  // in the files before the open file
};

}  // namespace lidar::mcap
