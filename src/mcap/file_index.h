// SPDX-License-Identifier: LGPL-2.1-or-later
// The index of a file: from its summary, or by a scan of a file without one.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "src/mcap/record_input.h"

namespace lidar::mcap {

/// A chunk, or a run of messages outside of chunks.
struct ChunkPlace {
  std::uint64_t start_time = 0;  // log times [ns], as the file claims
  std::uint64_t end_time = 0;
  std::uint64_t offset = 0;  // in the file; for a run, of its first record
  std::uint64_t size = 0;    // with all records
  bool is_run = false;
};

struct FileIndex {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<ChunkPlace> chunks;  // by start time
  bool complete = false;           // the file was closed in order
  std::uint64_t catalogue_size = 0;

  bool empty() const { return chunks.empty(); }
  std::uint64_t start_time() const;
  std::uint64_t end_time() const;
  /// Adds a new schema or channel. Returns false for other records, damaged ones and known ids,
  /// which stay unchanged. Memory stays within kMaxCatalogue.
  bool Learn(const Record& record);
  /// Calls Learn() with all records of a chunk.
  void LearnAll(ByteView records);
};

/// Reads the index of `input`, which begins with the magic. It never fails, but leaves unreadable
/// parts out. `known` is the index of the same file when it was shorter.
FileIndex ReadFileIndex(Input* input, FileIndex known = {});

/// Reads records from the end of the `known` ones to the first that is cut off.
FileIndex ScanFile(Input* input, FileIndex known = {});

}  // namespace lidar::mcap
