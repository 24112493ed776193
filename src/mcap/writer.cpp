// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/writer.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "src/base/crc.h"

namespace lidar::mcap {
namespace {

/// The limit for channels. It leaves room for the schemas.
constexpr std::size_t kMaxChannels = kMaxCatalogue / 4 * 3;

ByteView View(const Bytes& bytes) { return {bytes.data(), bytes.size()}; }

template <class T>
const T* FindId(const std::vector<T>& all, std::uint16_t id) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const T& t) { return t.id == id; });
  return found == all.end() ? nullptr : &*found;
}

/// Appends all records of one kind to the summary. Adds their position to `offsets`.
template <class Record>
void AppendGroup(Op group, const std::vector<Record>& records, std::uint64_t start, Bytes* out,
                 std::vector<SummaryOffset>* offsets) {
  if (records.empty()) return;
  const std::uint64_t at = start + out->size();
  for (const Record& record : records) Append(record, out);
  offsets->push_back({group, at, start + out->size() - at});
}

}  // namespace

std::uint16_t Catalogue::AddSchema(const Schema& schema) {
  const auto known = std::find_if(schemas.begin(), schemas.end(),
                                  [&](const Schema& s) { return s.name == schema.name; });
  if (known != schemas.end()) return known->id;
  schemas.push_back(schema);
  schemas.back().id = static_cast<std::uint16_t>(schemas.size());
  return schemas.back().id;
}

std::uint16_t Catalogue::AddChannel(Channel channel) {
  if (channels.size() == std::numeric_limits<std::uint16_t>::max()) return 0;
  Bytes record;
  Append(channel, &record);
  if (channel_bytes_ + record.size() > kMaxChannels) return 0;
  channel_bytes_ += record.size();
  channel.id = static_cast<std::uint16_t>(channels.size() + 1);
  channels.push_back(std::move(channel));
  return channels.back().id;
}

Writer::Writer(const WriterSettings& settings, const Catalogue* catalogue, Write write)
    : settings_(settings), catalogue_(*catalogue), write_(std::move(write)) {}

/// Returns true if a message of `size` bytes must begin another chunk.
bool Writer::IsFull(std::uint64_t log_time, std::size_t size) const {
  if (chunk_.empty()) return false;
  const auto longest = static_cast<std::uint64_t>(settings_.chunk_duration.count());
  const bool old = longest > 0 && log_time > chunk_start_ && log_time - chunk_start_ >= longest;
  return old || chunk_.size() >= settings_.chunk_size || chunk_.size() + size > kMaxMessage;
}

void Writer::AddChannelOnce(std::uint16_t id) {
  if (!message_indexes_.try_emplace(id, MessageIndex{id, {}}).second) return;
  const Channel* channel = FindId(catalogue_.channels, id);
  if (channel == nullptr) return;
  if (const Schema* schema = FindId(catalogue_.schemas, channel->schema_id))
    Append(*schema, &chunk_);
  Append(*channel, &chunk_);
}

bool Writer::Add(const MessageHeader& header, ByteView data) {
  const bool written = !IsFull(header.log_time, data.size) || Flush();
  if (chunk_.empty()) chunk_start_ = chunk_end_ = header.log_time;
  chunk_start_ = std::min(chunk_start_, header.log_time);
  chunk_end_ = std::max(chunk_end_, header.log_time);
  AddChannelOnce(header.channel_id);
  message_indexes_[header.channel_id].entries.emplace_back(header.log_time, chunk_.size());
  Append(header, data, &chunk_);
  return written;
}

Bytes Writer::BeginFile() const {
  Bytes bytes(kMagic.begin(), kMagic.end());
  Append(Header{"ros2", "gst-lidar"}, &bytes);
  return bytes;
}

bool Writer::Put(const Bytes& bytes) {
  if (!write_(View(bytes))) return false;
  data_crc_ = Crc32(View(bytes), data_crc_);
  offset_ += bytes.size();
  return true;
}

void Writer::AppendIndexes(ChunkIndex* index, Bytes* out) const {
  const std::size_t start = out->size();
  for (const auto& [id, entries] : message_indexes_) {
    index->message_index_offsets[id] = index->offset + index->size + out->size() - start;
    Append(entries, out);
  }
  index->message_index_size = out->size() - start;
}

void Writer::CountChunk() {
  Statistics& s = statistics_;
  s.start_time = s.messages > 0 ? std::min(s.start_time, chunk_start_) : chunk_start_;
  s.end_time = std::max(s.end_time, chunk_end_);
  for (const auto& [id, index] : message_indexes_) {
    s.messages += index.entries.size();
    s.messages_of[id] += index.entries.size();
  }
  ++s.chunks;
}

bool Writer::WriteChunk() {
  Bytes compressed;
  const bool smaller = Compress(settings_.compression, View(chunk_), &compressed);
  const Bytes& records = smaller ? compressed : chunk_;
  const Compression compression = smaller ? settings_.compression : Compression::kNone;
  const ChunkHeader header{chunk_start_,
                           chunk_end_,
                           chunk_.size(),
                           Crc32(View(chunk_)),
                           std::string(NameOf(compression)),
                           records.size()};
  Bytes out = offset_ == 0 ? BeginFile() : Bytes();
  ChunkIndex index{chunk_start_,       chunk_end_,     offset_ + out.size(), 0, {}, 0,
                   header.compression, records.size(), chunk_.size()};
  Append(header, View(records), &out);
  index.size = offset_ + out.size() - index.offset;
  AppendIndexes(&index, &out);
  if (!Put(out)) return false;
  chunk_indexes_.push_back(std::move(index));
  CountChunk();
  return true;
}

bool Writer::Flush() {
  if (chunk_.empty()) return true;
  const bool written = WriteChunk();
  chunk_.clear();
  message_indexes_.clear();
  return written;
}

Bytes Writer::Summary(std::uint64_t start) const {
  std::vector<Schema> schemas;
  std::vector<Channel> channels;
  for (const Channel& channel : catalogue_.channels) {
    if (statistics_.messages_of.count(channel.id) == 0) continue;
    const Schema* schema = FindId(catalogue_.schemas, channel.schema_id);
    if (schema != nullptr && FindId(schemas, schema->id) == nullptr) schemas.push_back(*schema);
    channels.push_back(channel);
  }
  Statistics statistics = statistics_;
  statistics.schemas = static_cast<std::uint16_t>(schemas.size());
  statistics.channels = static_cast<std::uint32_t>(channels.size());

  Bytes out;
  std::vector<SummaryOffset> offsets;
  AppendGroup(Op::kSchema, schemas, start, &out, &offsets);
  AppendGroup(Op::kChannel, channels, start, &out, &offsets);
  AppendGroup(Op::kStatistics, std::vector<Statistics>{statistics}, start, &out, &offsets);
  AppendGroup(Op::kChunkIndex, chunk_indexes_, start, &out, &offsets);
  Footer footer{start, start + out.size(), 0};
  for (const SummaryOffset& offset : offsets) Append(offset, &out);
  Append(footer, &out);
  // The checksum covers all bytes that are before it.
  const std::size_t crc_at = out.size() - sizeof footer.summary_crc;
  const std::uint32_t crc = Crc32({out.data(), crc_at});
  for (unsigned i = 0; i < 4; ++i) out[crc_at + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  return out;
}

bool Writer::Finish() {
  const bool flushed = Flush();
  if (chunk_indexes_.empty()) return flushed;
  Bytes out;
  AppendDataEnd(data_crc_, &out);
  const Bytes summary = Summary(offset_ + out.size());
  out.insert(out.end(), summary.begin(), summary.end());
  out.insert(out.end(), kMagic.begin(), kMagic.end());
  ended_ = Put(out);
  return ended_ && flushed;
}

}  // namespace lidar::mcap
