// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/records.h"

#include <algorithm>
#include <tuple>

#include "src/base/byte_writer.h"

namespace lidar::mcap {
namespace {

// The fields of each record in the order of the file. The types of the fields determine their
// format.
constexpr auto Fields(const Header*) { return std::tuple(&Header::profile, &Header::library); }
constexpr auto Fields(const Footer*) {
  return std::tuple(&Footer::summary_start, &Footer::summary_offset_start, &Footer::summary_crc);
}
constexpr auto Fields(const Schema*) {
  return std::tuple(&Schema::id, &Schema::name, &Schema::encoding, &Schema::text);
}
constexpr auto Fields(const Channel*) {
  return std::tuple(&Channel::id, &Channel::schema_id, &Channel::topic, &Channel::message_encoding,
                    &Channel::metadata);
}
constexpr auto Fields(const MessageHeader*) {
  return std::tuple(&MessageHeader::channel_id, &MessageHeader::sequence, &MessageHeader::log_time,
                    &MessageHeader::publish_time);
}
constexpr auto Fields(const ChunkHeader*) {
  return std::tuple(&ChunkHeader::start_time, &ChunkHeader::end_time,
                    &ChunkHeader::uncompressed_size, &ChunkHeader::uncompressed_crc,
                    &ChunkHeader::compression, &ChunkHeader::records_size);
}
constexpr auto Fields(const MessageIndex*) {
  return std::tuple(&MessageIndex::channel_id, &MessageIndex::entries);
}
constexpr auto Fields(const ChunkIndex*) {
  return std::tuple(&ChunkIndex::start_time, &ChunkIndex::end_time, &ChunkIndex::offset,
                    &ChunkIndex::size, &ChunkIndex::message_index_offsets,
                    &ChunkIndex::message_index_size, &ChunkIndex::compression,
                    &ChunkIndex::compressed_size, &ChunkIndex::uncompressed_size);
}
constexpr auto Fields(const Statistics*) {
  return std::tuple(&Statistics::messages, &Statistics::schemas, &Statistics::channels,
                    &Statistics::attachments, &Statistics::metadata_records, &Statistics::chunks,
                    &Statistics::start_time, &Statistics::end_time, &Statistics::messages_of);
}
constexpr auto Fields(const SummaryOffset*) {
  return std::tuple(&SummaryOffset::group, &SummaryOffset::start, &SummaryOffset::size);
}

/// Writes a record. The constructor writes the opcode and reserves the length, and the destructor
/// sets the length.
class RecordWriter : public ByteWriter {
 public:
  RecordWriter(Op op, mcap::Bytes* out) : ByteWriter(out), out_(*out) {
    U8(static_cast<std::uint8_t>(op));
    Le64(0);
    content_ = out->size();
  }
  ~RecordWriter() { SetLength(8, content_); }
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  template <class Fielded>
  RecordWriter& Put(const Fielded& record) {
    std::apply([&](auto... field) { (Field(record.*field), ...); }, Fields(&record));
    return *this;
  }

 private:
  void Field(Op v) { U8(static_cast<std::uint8_t>(v)); }
  void Field(std::uint16_t v) { Le16(v); }
  void Field(std::uint32_t v) { Le32(v); }
  void Field(std::uint64_t v) { Le64(v); }
  void Field(const std::string& text) {
    Le32(static_cast<std::uint32_t>(text.size()));
    Bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  /// Writes a map or an array of pairs.
  template <class Pairs, class = typename Pairs::iterator>
  void Field(const Pairs& pairs) {
    Le32(0);
    const std::size_t start = size();
    for (const auto& [first, second] : pairs) {
      Field(first);
      Field(second);
    }
    SetLength(4, start);
  }
  /// Sets the little-endian length of `n` bytes that is before `start`.
  void SetLength(unsigned n, std::size_t start) {
    const std::uint64_t length = size() - start;
    for (unsigned i = 0; i < n; ++i)
      out_[start - n + i] = static_cast<std::uint8_t>(length >> (8 * i));
  }
  mcap::Bytes& out_;
  std::size_t content_;
};

void Read(ByteReader* r, std::uint16_t* v) { *v = r->Le16(); }
void Read(ByteReader* r, std::uint32_t* v) { *v = r->Le32(); }
void Read(ByteReader* r, std::uint64_t* v) { *v = r->Le64(); }
void Read(ByteReader* r, std::string* text) {
  const ByteView v = r->Bytes(r->Le32());
  text->assign(reinterpret_cast<const char*>(v.data), v.size);
}
template <class Key, class Value>
void Read(ByteReader* r, std::map<Key, Value>* map) {
  ByteReader entries(r->Bytes(r->Le32()));
  while (entries.remaining() > 0 && entries.ok()) {
    Key key{};
    Value value{};
    Read(&entries, &key);
    Read(&entries, &value);
    if (entries.ok()) (*map)[std::move(key)] = std::move(value);
  }
  if (!entries.ok()) r->Skip(SIZE_MAX);  // makes the outer reader fail, too
}

template <class Fielded>
std::optional<Fielded> Parse(ByteReader* r) {
  Fielded record;
  std::apply([&](auto... field) { (Read(r, &(record.*field)), ...); }, Fields(&record));
  if (!r->ok()) return std::nullopt;
  return record;
}
template <class Fielded>
std::optional<Fielded> Parse(ByteView content) {
  ByteReader r(content);
  return Parse<Fielded>(&r);
}

/// Parses a chunk's record. If the chunk claims to end before it starts, its end is set to its
/// start.
template <class Chunk, class Source>
std::optional<Chunk> ParseChunk(Source source) {
  auto chunk = Parse<Chunk>(source);
  if (chunk) chunk->end_time = std::max(chunk->start_time, chunk->end_time);
  return chunk;
}

}  // namespace

void Append(const Header& header, Bytes* out) { RecordWriter(Op::kHeader, out).Put(header); }
void Append(const Footer& footer, Bytes* out) { RecordWriter(Op::kFooter, out).Put(footer); }
void Append(const Schema& schema, Bytes* out) { RecordWriter(Op::kSchema, out).Put(schema); }
void Append(const Channel& channel, Bytes* out) { RecordWriter(Op::kChannel, out).Put(channel); }
void Append(const MessageHeader& header, ByteView data, Bytes* out) {
  RecordWriter(Op::kMessage, out).Put(header).Bytes(data);
}
void Append(ChunkHeader header, ByteView records, Bytes* out) {
  header.records_size = records.size;
  RecordWriter(Op::kChunk, out).Put(header).Bytes(records);
}
void Append(const MessageIndex& index, Bytes* out) {
  RecordWriter(Op::kMessageIndex, out).Put(index);
}
void Append(const ChunkIndex& index, Bytes* out) { RecordWriter(Op::kChunkIndex, out).Put(index); }
void Append(const Statistics& statistics, Bytes* out) {
  RecordWriter(Op::kStatistics, out).Put(statistics);
}
void Append(const SummaryOffset& offset, Bytes* out) {
  RecordWriter(Op::kSummaryOffset, out).Put(offset);
}
void AppendDataEnd(std::uint32_t crc, Bytes* out) { RecordWriter(Op::kDataEnd, out).Le32(crc); }

std::optional<Footer> ParseFooter(ByteView content) { return Parse<Footer>(content); }
std::optional<Schema> ParseSchema(ByteView content) {
  auto schema = Parse<Schema>(content);
  if (schema && schema->id == 0) schema.reset();
  return schema;
}
std::optional<Channel> ParseChannel(ByteView content) { return Parse<Channel>(content); }
std::optional<MessageHeader> ParseMessage(ByteView content, ByteView* data) {
  ByteReader r(content);
  const auto header = Parse<MessageHeader>(&r);
  *data = r.Rest();
  return header;
}
std::optional<ChunkHeader> ParseChunkHeader(ByteView content, std::size_t* header_size) {
  ByteReader r(content);
  auto header = ParseChunk<ChunkHeader>(&r);
  *header_size = r.position();
  return header;
}
std::optional<ChunkIndex> ParseChunkIndex(ByteView content) {
  return ParseChunk<ChunkIndex>(content);
}
std::optional<Statistics> ParseStatistics(ByteView content) { return Parse<Statistics>(content); }

std::optional<Record> NextRecord(ByteView bytes, std::size_t* offset) {
  const std::size_t start = *offset;
  ByteReader r(bytes.Sub(start));
  const auto op = static_cast<Op>(r.U8());
  const std::uint64_t length = r.Le64();
  if (!r.ok() || length > r.remaining()) return std::nullopt;
  *offset = start + kRecordHeaderSize + static_cast<std::size_t>(length);
  return Record{op, r.Bytes(static_cast<std::size_t>(length)), start};
}

}  // namespace lidar::mcap
