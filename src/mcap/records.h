// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes and parses the records of an MCAP file (mcap.dev/spec).
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::mcap {

using Bytes = std::vector<std::uint8_t>;
using Metadata = std::map<std::string, std::string>;

/// The bytes with which a file begins and ends.
constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

enum class Op : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// The size of the opcode and the length, which are before the content of each record.
constexpr std::size_t kRecordHeaderSize = 9;

struct Header {
  std::string profile;
  std::string library;
};
struct Footer {
  static constexpr std::size_t kSize = 20;  // size of the content
  std::uint64_t summary_start = 0;          // 0: there is no summary
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;
};
struct Schema {
  std::uint16_t id = 0;  // never 0
  std::string name;
  std::string encoding;
  std::string text;
};
struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  // 0: the channel has no schema
  std::string topic;
  std::string message_encoding;
  Metadata metadata;
};
/// The key in a channel's metadata under which our recordings store the caps of the stream.
inline constexpr const char* kCapsKey = "gst_caps";
struct MessageHeader {
  static constexpr std::size_t kSize = 22;
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;      // [ns]
  std::uint64_t publish_time = 0;  // [ns]
};
struct ChunkHeader {
  std::uint64_t start_time = 0;  // log times of the first and the last message [ns]
  std::uint64_t end_time = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  // 0: not known
  std::string compression;             // empty, "lz4" or "zstd"
  std::uint64_t records_size = 0;      // size of the records that follow, after compression
};
/// The log times of a channel's messages, and the messages' offsets in the uncompressed chunk.
struct MessageIndex {
  std::uint16_t channel_id = 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> entries;
};
struct ChunkIndex {
  std::uint64_t start_time = 0;
  std::uint64_t end_time = 0;
  std::uint64_t offset = 0;  // offset of the chunk record in the file
  std::uint64_t size = 0;    // size of the chunk record with its opcode and length
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_size = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};
struct Statistics {
  std::uint64_t messages = 0;
  std::uint16_t schemas = 0;
  std::uint32_t channels = 0;
  std::uint32_t attachments = 0;
  std::uint32_t metadata_records = 0;
  std::uint32_t chunks = 0;
  std::uint64_t start_time = 0;  // of all messages; 0: there are no messages
  std::uint64_t end_time = 0;
  std::map<std::uint16_t, std::uint64_t> messages_of;  // by channel
};
/// The position of all records of one kind in the summary.
struct SummaryOffset {
  Op group = Op::kHeader;
  std::uint64_t start = 0;
  std::uint64_t size = 0;
};

/// The functions below append a whole record to `out`.
void Append(const Header& header, Bytes* out);
void Append(const Footer& footer, Bytes* out);
void Append(const Schema& schema, Bytes* out);
void Append(const Channel& channel, Bytes* out);
void Append(const MessageHeader& header, ByteView data, Bytes* out);
/// Sets `records_size` to the size of `records`.
void Append(ChunkHeader header, ByteView records, Bytes* out);
void Append(const MessageIndex& index, Bytes* out);
void Append(const ChunkIndex& index, Bytes* out);
void Append(const Statistics& statistics, Bytes* out);
void Append(const SummaryOffset& offset, Bytes* out);
/// `crc` is the checksum of the data section, or 0 if it is unknown.
void AppendDataEnd(std::uint32_t crc, Bytes* out);

/// These functions parse the content of a record. Fields of later versions of MCAP may follow the
/// known fields. The functions return nothing if the content is incomplete.
std::optional<Footer> ParseFooter(ByteView content);
std::optional<Schema> ParseSchema(ByteView content);
std::optional<Channel> ParseChannel(ByteView content);
/// Sets `data` to the part of `content` that is the message itself.
std::optional<MessageHeader> ParseMessage(ByteView content, ByteView* data);
/// Sets `header_size` to the size of the header. `content` may end after the header, because the
/// records are not read.
std::optional<ChunkHeader> ParseChunkHeader(ByteView content, std::size_t* header_size);
std::optional<ChunkIndex> ParseChunkIndex(ByteView content);
std::optional<Statistics> ParseStatistics(ByteView content);

/// A record in a sequence of records.
struct Record {
  Op op;
  ByteView content;
  std::size_t offset;  // offset of its opcode in the sequence
};
/// Returns the record at `*offset` in `bytes`, and moves `*offset` behind it. Returns nothing at
/// the end, and if the record is incomplete.
std::optional<Record> NextRecord(ByteView bytes, std::size_t* offset);

}  // namespace lidar::mcap
