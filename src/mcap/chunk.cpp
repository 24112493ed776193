// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/chunk.h"

#include "src/base/crc.h"
#include "src/mcap/compression.h"

namespace lidar::mcap {
namespace {

constexpr std::uint64_t kMaxChunkHeader = 64;  // has room for a short name of the compression

struct PlacedHeader {
  ChunkHeader chunk;
  std::size_t size = 0;
};

std::optional<PlacedHeader> ReadHeader(Input* input, const RecordPlace& record) {
  Bytes bytes;
  if (record.op != Op::kChunk || !ReadContent(input, record, kMaxChunkHeader, &bytes))
    return std::nullopt;
  PlacedHeader header;
  const auto chunk = ParseChunkHeader({bytes.data(), bytes.size()}, &header.size);
  if (!chunk || chunk->records_size > record.size - header.size ||
      chunk->uncompressed_size > kMaxChunk)
    return std::nullopt;
  header.chunk = *chunk;
  return header;
}

bool ReadRun(Input* input, const ChunkPlace& run, Bytes* records) {
  if (run.size > kMaxChunk) return false;
  records->resize(static_cast<std::size_t>(run.size));
  return input->Read(run.offset, records->size(), records->data());
}

}  // namespace

std::optional<ChunkHeader> ReadChunkHeader(Input* input, const RecordPlace& record) {
  const auto header = ReadHeader(input, record);
  if (!header) return std::nullopt;
  return header->chunk;
}

bool ReadChunk(Input* input, const ChunkPlace& chunk, Bytes* records) {
  if (chunk.is_run) return ReadRun(input, chunk, records);
  const auto record = RecordAt(input, chunk.offset);
  // The record must not be larger than the index says, because chunks would then overlap.
  const bool fits = record && record->end() - chunk.offset <= chunk.size;
  const auto header = fits ? ReadHeader(input, *record) : std::nullopt;
  if (!header || header->chunk.records_size > 2 * kMaxChunk) return false;
  Bytes stored(static_cast<std::size_t>(header->chunk.records_size));
  if (!input->Read(record->content + header->size, stored.size(), stored.data())) return false;
  const auto size = static_cast<std::size_t>(header->chunk.uncompressed_size);
  if (!Decompress(header->chunk.compression, {stored.data(), stored.size()}, size, records))
    return false;
  const std::uint32_t crc = header->chunk.uncompressed_crc;
  return crc == 0 || Crc32({records->data(), records->size()}) == crc;
}

}  // namespace lidar::mcap
