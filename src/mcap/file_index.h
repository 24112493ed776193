// SPDX-License-Identifier: LGPL-2.1-or-later
// The index of a file. It is read from the summary, or by a scan if the file has no summary.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "src/mcap/record_input.h"

namespace lidar::mcap {

/// The position of a chunk, or of a run of messages outside of chunks.
struct ChunkPlace {
  std::uint64_t start_time = 0;  // log times [ns], as the file claims
  std::uint64_t end_time = 0;
  std::uint64_t offset = 0;  // offset in the file of the chunk, or of a run's first record
  std::uint64_t size = 0;    // size of all its records
  bool is_run = false;
};

struct FileIndex {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<ChunkPlace> chunks;  // ordered by start time
  bool complete = false;           // the file was closed properly
  std::uint64_t catalogue_size = 0;

  bool empty() const { return chunks.empty(); }
  std::uint64_t start_time() const;
  std::uint64_t end_time() const;
  /// Adds a new schema or channel. Returns false if the record is of another type or damaged, or if
  /// its id is known. A known schema or channel is not changed. The memory is limited to
  /// kMaxCatalogue.
  bool Learn(const Record& record);
  /// Calls Learn() for all records of a chunk.
  void LearnAll(ByteView records);
};

/// Reads the index of `input`, which must begin with the magic. Never fails, but skips parts that
/// cannot be read. `known` is the index of the same file at a time when the file was shorter.
FileIndex ReadFileIndex(Input* input, FileIndex known = {});

/// Reads records from the end of the `known` records up to the first incomplete record.
FileIndex ScanFile(Input* input, FileIndex known = {});

}  // namespace lidar::mcap
