// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/records.h"

#include "src/base/byte_writer.h"

namespace lidar::mcap {
namespace {

/// Writes opcode and length, and sets the length at the end.
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

  void Text(const std::string& text) {
    Le32(static_cast<std::uint32_t>(text.size()));
    Bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  /// A map or an array; `write` writes its entries.
  template <class Write>
  void Entries(Write write) {
    Le32(0);
    const std::size_t start = size();
    write();
    SetLength(4, start);
  }

 private:
  /// Sets the little-endian length of `n` bytes that stands before `start`.
  void SetLength(unsigned n, std::size_t start) {
    const std::uint64_t length = size() - start;
    for (unsigned i = 0; i < n; ++i)
      out_[start - n + i] = static_cast<std::uint8_t>(length >> (8 * i));
  }
  mcap::Bytes& out_;
  std::size_t content_;
};

std::string Text(ByteReader* r) {
  const ByteView v = r->Bytes(r->Le32());
  return {reinterpret_cast<const char*>(v.data), v.size};
}

Metadata TextMap(ByteReader* r) {
  Metadata map;
  ByteReader entries(r->Bytes(r->Le32()));
  while (entries.remaining() > 0) {
    std::string key = Text(&entries);
    std::string value = Text(&entries);
    if (!entries.ok()) break;
    map[std::move(key)] = std::move(value);
  }
  if (!entries.ok()) r->Skip(SIZE_MAX);  // makes the reader fail
  return map;
}

std::map<std::uint16_t, std::uint64_t> CountMap(ByteReader* r) {
  std::map<std::uint16_t, std::uint64_t> map;
  ByteReader entries(r->Bytes(r->Le32()));
  while (entries.remaining() > 0 && entries.ok()) {
    const std::uint16_t key = entries.Le16();
    map[key] = entries.Le64();
  }
  if (!entries.ok()) r->Skip(SIZE_MAX);
  return map;
}

void WriteCounts(const std::map<std::uint16_t, std::uint64_t>& map, RecordWriter* w) {
  w->Entries([&] {
    for (const auto& [key, value] : map) {
      w->Le16(key);
      w->Le64(value);
    }
  });
}

template <class T>
std::optional<T> Checked(const ByteReader& r, T value) {
  if (!r.ok()) return std::nullopt;
  return value;
}

}  // namespace

void Append(const Header& header, Bytes* out) {
  RecordWriter w(Op::kHeader, out);
  w.Text(header.profile);
  w.Text(header.library);
}

void Append(const Footer& footer, Bytes* out) {
  RecordWriter w(Op::kFooter, out);
  w.Le64(footer.summary_start);
  w.Le64(footer.summary_offset_start);
  w.Le32(footer.summary_crc);
}

void Append(const Schema& schema, Bytes* out) {
  RecordWriter w(Op::kSchema, out);
  w.Le16(schema.id);
  w.Text(schema.name);
  w.Text(schema.encoding);
  w.Text(schema.text);
}

void Append(const Channel& channel, Bytes* out) {
  RecordWriter w(Op::kChannel, out);
  w.Le16(channel.id);
  w.Le16(channel.schema_id);
  w.Text(channel.topic);
  w.Text(channel.message_encoding);
  w.Entries([&] {
    for (const auto& [key, value] : channel.metadata) {
      w.Text(key);
      w.Text(value);
    }
  });
}

void Append(const MessageHeader& header, ByteView data, Bytes* out) {
  RecordWriter w(Op::kMessage, out);
  w.Le16(header.channel_id);
  w.Le32(header.sequence);
  w.Le64(header.log_time);
  w.Le64(header.publish_time);
  w.Bytes(data);
}

void Append(const ChunkHeader& header, ByteView records, Bytes* out) {
  RecordWriter w(Op::kChunk, out);
  w.Le64(header.start_time);
  w.Le64(header.end_time);
  w.Le64(header.uncompressed_size);
  w.Le32(header.uncompressed_crc);
  w.Text(header.compression);
  w.Le64(records.size);
  w.Bytes(records);
}

void Append(const MessageIndex& index, Bytes* out) {
  RecordWriter w(Op::kMessageIndex, out);
  w.Le16(index.channel_id);
  w.Entries([&] {
    for (const auto& [time, offset] : index.entries) {
      w.Le64(time);
      w.Le64(offset);
    }
  });
}

void Append(const ChunkIndex& index, Bytes* out) {
  RecordWriter w(Op::kChunkIndex, out);
  w.Le64(index.start_time);
  w.Le64(index.end_time);
  w.Le64(index.offset);
  w.Le64(index.size);
  WriteCounts(index.message_index_offsets, &w);
  w.Le64(index.message_index_size);
  w.Text(index.compression);
  w.Le64(index.compressed_size);
  w.Le64(index.uncompressed_size);
}

void Append(const Statistics& s, Bytes* out) {
  RecordWriter w(Op::kStatistics, out);
  w.Le64(s.messages);
  w.Le16(s.schemas);
  w.Le32(s.channels);
  w.Le32(0);  // attachments
  w.Le32(0);  // metadata records
  w.Le32(s.chunks);
  w.Le64(s.start_time);
  w.Le64(s.end_time);
  WriteCounts(s.messages_of, &w);
}

void Append(const SummaryOffset& offset, Bytes* out) {
  RecordWriter w(Op::kSummaryOffset, out);
  w.U8(static_cast<std::uint8_t>(offset.group));
  w.Le64(offset.start);
  w.Le64(offset.size);
}

void AppendDataEnd(std::uint32_t crc, Bytes* out) {
  RecordWriter w(Op::kDataEnd, out);
  w.Le32(crc);
}

std::optional<Header> ParseHeader(ByteView content) {
  ByteReader r(content);
  Header header;
  header.profile = Text(&r);
  header.library = Text(&r);
  return Checked(r, std::move(header));
}

std::optional<Footer> ParseFooter(ByteView content) {
  ByteReader r(content);
  Footer footer;
  footer.summary_start = r.Le64();
  footer.summary_offset_start = r.Le64();
  footer.summary_crc = r.Le32();
  return Checked(r, footer);
}

std::optional<Schema> ParseSchema(ByteView content) {
  ByteReader r(content);
  Schema schema;
  schema.id = r.Le16();
  schema.name = Text(&r);
  schema.encoding = Text(&r);
  schema.text = Text(&r);
  if (schema.id == 0) return std::nullopt;
  return Checked(r, std::move(schema));
}

std::optional<Channel> ParseChannel(ByteView content) {
  ByteReader r(content);
  Channel channel;
  channel.id = r.Le16();
  channel.schema_id = r.Le16();
  channel.topic = Text(&r);
  channel.message_encoding = Text(&r);
  channel.metadata = TextMap(&r);
  return Checked(r, std::move(channel));
}

std::optional<MessageHeader> ParseMessage(ByteView content, ByteView* data) {
  ByteReader r(content);
  MessageHeader header;
  header.channel_id = r.Le16();
  header.sequence = r.Le32();
  header.log_time = r.Le64();
  header.publish_time = r.Le64();
  *data = r.Rest();
  return Checked(r, header);
}

std::optional<ChunkHeader> ParseChunkHeader(ByteView content, std::size_t* header_size) {
  ByteReader r(content);
  ChunkHeader header;
  header.start_time = r.Le64();
  header.end_time = r.Le64();
  header.uncompressed_size = r.Le64();
  header.uncompressed_crc = r.Le32();
  header.compression = Text(&r);
  header.records_size = r.Le64();
  *header_size = r.position();
  return Checked(r, std::move(header));
}

std::optional<ChunkIndex> ParseChunkIndex(ByteView content) {
  ByteReader r(content);
  ChunkIndex index;
  index.start_time = r.Le64();
  index.end_time = r.Le64();
  index.offset = r.Le64();
  index.size = r.Le64();
  index.message_index_offsets = CountMap(&r);
  index.message_index_size = r.Le64();
  index.compression = Text(&r);
  index.compressed_size = r.Le64();
  index.uncompressed_size = r.Le64();
  return Checked(r, std::move(index));
}

std::optional<Statistics> ParseStatistics(ByteView content) {
  ByteReader r(content);
  Statistics s;
  s.messages = r.Le64();
  s.schemas = r.Le16();
  s.channels = r.Le32();
  r.Skip(8);  // attachments, metadata records
  s.chunks = r.Le32();
  s.start_time = r.Le64();
  s.end_time = r.Le64();
  s.messages_of = CountMap(&r);
  return Checked(r, std::move(s));
}

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
