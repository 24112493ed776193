// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes an MCAP file: chunks with their indexes, followed by the summary.
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

/// The largest size of a message. It is smaller than kMaxChunk, because a chunk also contains its
/// channels.
constexpr std::size_t kMaxMessage = kMaxChunk - (std::size_t{1} << 20);  // bytes

struct WriterSettings {
  Compression compression = Compression::kZstd;
  std::size_t chunk_size = std::size_t{1} << 20;  // a chunk ends when it is larger [bytes]
  Duration chunk_duration = std::chrono::seconds(1);
};

/// The schemas and channels of a recording, which may have several files.
class Catalogue {
 public:
  std::vector<Schema> schemas;
  std::vector<Channel> channels;

  /// Returns the id of the schema with the same name. Adds the schema if there is none.
  std::uint16_t AddSchema(const Schema& schema);
  /// Adds a channel and returns its id. Returns 0 if there are 65,535 channels, or if the channels
  /// need more memory than a reader accepts.
  std::uint16_t AddChannel(Channel channel);

 private:
  std::size_t channel_bytes_ = 0;
};

/// Writes a file. Each chunk contains the schemas and channels that it uses, so a reader needs no
/// other chunk.
class Writer {
 public:
  /// A function that appends all bytes to the file, or none of them. Returns false if that failed.
  using Write = std::function<bool(ByteView)>;

  /// `catalogue` must outlive this object. Channels may be added to it later.
  Writer(const WriterSettings& settings, const Catalogue* catalogue, Write write);

  /// Adds a message of at most kMaxMessage bytes. Writes the open chunk before, if it is full. If
  /// Add() returns false, Finish() may still succeed.
  bool Add(const MessageHeader& header, ByteView data);
  /// Writes the open chunk. Returns false if that failed.
  bool Flush();
  /// Writes the open chunk, the summary and the footer. Writes nothing if there are no messages.
  bool Finish();

  /// Returns the size of the file, including the open chunk [bytes].
  std::uint64_t size() const { return offset_ + chunk_.size(); }
  /// Returns the number of chunks that were written.
  std::size_t chunks() const { return chunk_indexes_.size(); }
  /// Returns true if the end of the file was written.
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

  std::uint64_t offset_ = 0;    // size of the file so far
  std::uint32_t data_crc_ = 0;  // checksum of the file up to offset_
  bool ended_ = false;
  // The members of the open chunk.
  Bytes chunk_;
  std::uint64_t chunk_start_ = 0;
  std::uint64_t chunk_end_ = 0;
  std::map<std::uint16_t, MessageIndex> message_indexes_;
  std::vector<ChunkIndex> chunk_indexes_;  // one for each written chunk
  Statistics statistics_;
};

}  // namespace lidar::mcap
