// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the messages of an MCAP file in the order of their log times. The file may have any
// contents.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/mcap/file_index.h"

namespace lidar::mcap {

/// A message. Its `data` belong to the reader, and are valid until the next call of the reader.
struct Message {
  MessageHeader header;
  ByteView data;
};

class Reader {
 public:
  /// Opens a file. Returns nothing and sets `why`, a text for users, if `input` is not an MCAP
  /// file. `known` is the index of the same file at a time when the file was shorter.
  static std::unique_ptr<Reader> Open(std::unique_ptr<Input> input, std::string* why,
                                      FileIndex known = {});

  /// Returns the index. If the file is incomplete, each message may add schemas and channels.
  const FileIndex& index() const { return index_; }
  /// Returns the number of chunks that were skipped.
  std::uint64_t damaged_chunks() const { return damaged_chunks_; }

  /// Continues with the first message whose log time is `log_time` or later.
  void Seek(std::uint64_t log_time);
  /// Returns the next message of a known channel, or nothing at the end. Messages of overlapping
  /// chunks are merged by their times.
  std::optional<Message> Next();

 private:
  struct Entry {
    std::uint64_t log_time = 0;
    std::size_t offset = 0;  // offset in `records`
  };
  struct OpenChunk {
    Bytes records;
    std::vector<Entry> entries;  // ordered by log time
    std::size_t next = 0;

    bool ended() const { return next == entries.size(); }
    std::uint64_t time() const { return entries[next].log_time; }
  };

  Reader(std::unique_ptr<Input> input, FileIndex known);
  bool WantsNextChunk() const;
  void OpenNextChunk();
  void FindMessages(OpenChunk* chunk);
  bool Knows(std::uint16_t channel);
  OpenChunk* Earliest();

  const std::unique_ptr<Input> input_;
  FileIndex index_;
  std::uint64_t from_ = 0;
  std::size_t next_chunk_ = 0;
  std::size_t learnt_chunks_ = 0;  // number of first chunks whose channels are known
  std::deque<OpenChunk> open_;
  std::uint64_t damaged_chunks_ = 0;
};

}  // namespace lidar::mcap
