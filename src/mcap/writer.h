// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes an MCAP file: chunks with indexes, then the summary.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "src/base/time.h"
#include "src/mcap/compression.h"
#include "src/mcap/record_input.h"
#include "src/mcap/records.h"

namespace lidar::mcap {

/// The largest message. Readers accept chunks of kMaxChunk, and a chunk also holds its channels.
constexpr std::size_t kMaxMessage = kMaxChunk - (std::size_t{1} << 20);  // bytes

struct WriterSettings {
  Compression compression = Compression::kZstd;
  std::size_t chunk_size = std::size_t{1} << 20;  // a chunk ends once it is larger [bytes]
  Duration chunk_duration = std::chrono::seconds(1);
};

/// The schemas and channels of a recording, which may have several files.
class Catalogue {
 public:
  std::vector<Schema> schemas;
  std::vector<Channel> channels;

  /// Returns the id of the schema with that name, and adds the schema if it is missing.
  std::uint16_t AddSchema(const Schema& schema);
  /// Adds a channel and returns its id; 0 if there are 65,535 channels, or more than a reader
  /// accepts.
  std::uint16_t AddChannel(Channel channel);

 private:
  std::size_t channel_bytes_ = 0;
};

/// Writes a file. Each chunk holds the schemas and channels that it uses, so it can be read alone.
class Writer {
 public:
  /// Appends to the file, all or nothing. Returns false if that failed.
  using Write = std::function<bool(ByteView)>;

  /// `catalogue` outlives this object, and may grow.
  Writer(const WriterSettings& settings, const Catalogue* catalogue, Write write);

  /// Takes a message of at most kMaxMessage bytes, and writes a chunk if one is full. Finish() may
  /// still work after Add() has returned false.
  bool Add(const MessageHeader& header, ByteView data);
  /// Writes the open chunk.
  bool Flush();
  /// Writes the open chunk, the index and the footer; an empty recording writes no byte.
  bool Finish();

  /// Bytes of the file so far, with the open chunk.
  std::uint64_t size() const { return offset_ + chunk_.size(); }
  /// Chunks that have been written.
  std::size_t chunks() const { return chunk_indexes_.size(); }
  /// Returns true once the file's end is written.
  bool ended() const { return ended_; }
  const Statistics& statistics() const { return statistics_; }

 private:
  bool IsFull(std::uint64_t log_time, std::size_t size) const;
  void AddChannelOnce(std::uint16_t id);
  Bytes BeginFile() const;
  bool WriteChunk();
  void AppendIndexes(ChunkIndex* index, Bytes* out) const;
  void CountChunk();
  Bytes Summary(std::uint64_t start) const;
  bool Put(const Bytes& bytes);

  const WriterSettings settings_;
  const Catalogue& catalogue_;
  const Write write_;

  std::uint64_t offset_ = 0;    // of the end of the file
  std::uint32_t data_crc_ = 0;  // of the file up to offset_
  bool ended_ = false;
  // The open chunk.
  Bytes chunk_;
  std::uint64_t chunk_start_ = 0;
  std::uint64_t chunk_end_ = 0;
  std::map<std::uint16_t, MessageIndex> message_indexes_;
  std::vector<ChunkIndex> chunk_indexes_;  // one for each chunk written
  Statistics statistics_;
};

}  // namespace lidar::mcap
