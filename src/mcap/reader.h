// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the messages of an MCAP file by their log times. The file may hold any bytes.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/mcap/file_index.h"

namespace lidar::mcap {

/// A message; `data` belong to the reader and are valid until its next call.
struct Message {
  MessageHeader header;
  ByteView data;
};

class Reader {
 public:
  /// Returns nothing if `input` is not an MCAP file; `why` then has the reason for a user. `known`
  /// is the index of the same file when it was shorter.
  static std::unique_ptr<Reader> Open(std::unique_ptr<Input> input, std::string* why,
                                      FileIndex known = {});

  /// Schemas and channels of a file that broke off may grow with each message.
  const FileIndex& index() const { return index_; }
  /// Chunks that were left out.
  std::uint64_t damaged_chunks() const { return damaged_chunks_; }

  /// Continues with the first message of `log_time` or later.
  void Seek(std::uint64_t log_time);
  /// The next message of a known channel; nothing at the end. Chunks that overlap are merged.
  std::optional<Message> Next();

 private:
  struct Entry {
    std::uint64_t log_time = 0;
    std::size_t offset = 0;  // in the records
  };
  struct OpenChunk {
    Bytes records;
    std::vector<Entry> entries;  // by log time
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
  std::size_t learnt_chunks_ = 0;  // number of the first chunks whose channels the index has
  std::deque<OpenChunk> open_;
  std::uint64_t damaged_chunks_ = 0;
};

}  // namespace lidar::mcap
