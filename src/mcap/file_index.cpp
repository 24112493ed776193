// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/file_index.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "src/base/crc.h"

namespace lidar::mcap {
namespace {

constexpr std::uint64_t kFooterRecord = kRecordHeaderSize + Footer::kSize;
constexpr std::uint64_t kFileEnd = kFooterRecord + kMagic.size();

struct SummaryPlace {
  std::uint64_t start = 0;
  std::uint64_t end = 0;  // begin of the footer
  std::uint32_t crc = 0;
};

/// Finds the summary. Returns nothing if the file was not closed. The summary of a closed file may
/// be empty.
std::optional<SummaryPlace> FindSummary(Input* input) {
  const std::uint64_t size = input->size();
  if (size < kMagic.size() + kFileEnd || !HasMagic(input, size - kMagic.size()))
    return std::nullopt;
  const std::uint64_t footer_at = size - kFileEnd;
  const auto place = RecordAt(input, footer_at);
  Bytes content;
  if (!place || place->op != Op::kFooter || !ReadContent(input, *place, Footer::kSize, &content))
    return std::nullopt;
  const auto footer = ParseFooter({content.data(), content.size()});
  if (footer && footer->summary_start == 0) return SummaryPlace{footer_at, footer_at, 0};
  if (!footer || footer->summary_start < kMagic.size() || footer->summary_start > footer_at ||
      footer_at - footer->summary_start > kMaxSummary)
    return std::nullopt;
  return SummaryPlace{footer->summary_start, footer_at, footer->summary_crc};
}

/// Returns the records of the summary, or nothing if the summary's checksum is wrong.
std::optional<Bytes> ReadSummary(Input* input, const SummaryPlace& place) {
  // The checksum also covers the footer, up to the checksum itself.
  constexpr std::uint64_t kCovered = kFooterRecord - 4;
  Bytes bytes(static_cast<std::size_t>(place.end - place.start + kCovered));
  if (!input->Read(place.start, bytes.size(), bytes.data())) return std::nullopt;
  if (place.crc != 0 && Crc32({bytes.data(), bytes.size()}) != place.crc) return std::nullopt;
  bytes.resize(bytes.size() - kCovered);
  return bytes;
}

void AddChunk(const Input& input, const Record& record, FileIndex* index) {
  const auto chunk = ParseChunkIndex(record.content);
  if (!chunk || chunk->offset > input.size() || chunk->size > input.size() - chunk->offset) return;
  index->chunks.push_back({chunk->start_time, chunk->end_time, chunk->offset, chunk->size, false});
}

/// Removes chunks that overlap an earlier chunk. Reading a small file with many overlapping chunks
/// would otherwise take any amount of time.
void DropOverlaps(std::vector<ChunkPlace>* chunks) {
  std::stable_sort(chunks->begin(), chunks->end(),
                   [](const ChunkPlace& a, const ChunkPlace& b) { return a.offset < b.offset; });
  std::uint64_t end = 0;
  const auto overlaps = [&](const ChunkPlace& chunk) {
    if (chunk.offset < end) return true;
    end = chunk.offset + chunk.size;
    return false;
  };
  chunks->erase(std::remove_if(chunks->begin(), chunks->end(), overlaps), chunks->end());
}

bool LacksASchema(const FileIndex& index) {
  return std::any_of(index.channels.begin(), index.channels.end(), [&](const auto& c) {
    return c.second.schema_id != 0 && index.schemas.count(c.second.schema_id) == 0;
  });
}

}  // namespace

std::uint64_t FileIndex::start_time() const {
  // Skips chunks without messages. They have no times, so both times are 0.
  for (const ChunkPlace& chunk : chunks)
    if (chunk.end_time > 0) return chunk.start_time;
  return 0;
}

std::uint64_t FileIndex::end_time() const {
  std::uint64_t end = 0;
  for (const ChunkPlace& chunk : chunks) end = std::max(end, chunk.end_time);
  return end;
}

bool FileIndex::Learn(const Record& record) {
  if (catalogue_size + record.content.size > kMaxCatalogue) return false;
  bool is_new = false;
  if (record.op == Op::kSchema) {
    auto schema = ParseSchema(record.content);
    is_new = schema && schemas.try_emplace(schema->id, *std::move(schema)).second;
  } else if (record.op == Op::kChannel) {
    auto channel = ParseChannel(record.content);
    is_new = channel && channels.try_emplace(channel->id, *std::move(channel)).second;
  }
  if (is_new) catalogue_size += record.content.size;
  return is_new;
}

void FileIndex::LearnAll(ByteView records) {
  std::size_t offset = 0;
  while (const auto record = NextRecord(records, &offset)) Learn(*record);
}

FileIndex ReadFileIndex(Input* input, FileIndex known) {
  const auto place = FindSummary(input);
  const auto summary = place ? ReadSummary(input, *place) : std::nullopt;
  if (!summary) return ScanFile(input, std::move(known));
  FileIndex index;
  std::size_t offset = 0;
  while (const auto record = NextRecord({summary->data(), summary->size()}, &offset)) {
    if (record->op == Op::kChunkIndex)
      AddChunk(*input, *record, &index);
    else
      index.Learn(*record);
  }
  // Files of other writers may lack the indexes or the schemas.
  if (index.chunks.empty() || index.channels.empty() || LacksASchema(index))
    index = ScanFile(input);
  index.complete = true;
  DropOverlaps(&index.chunks);
  std::stable_sort(
      index.chunks.begin(), index.chunks.end(),
      [](const ChunkPlace& a, const ChunkPlace& b) { return a.start_time < b.start_time; });
  return index;
}

}  // namespace lidar::mcap
