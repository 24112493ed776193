// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/reader.h"

#include <algorithm>
#include <utility>

#include "src/mcap/chunk.h"

namespace lidar::mcap {
namespace {

/// The limit of memory for overlapping chunks [bytes]. If it is exceeded, messages of different
/// chunks are no longer merged by their times.
constexpr std::size_t kMaxOpen = std::size_t{128} << 20;
constexpr std::size_t kMaxOpenChunks = 64;

}  // namespace

std::unique_ptr<Reader> Reader::Open(std::unique_ptr<Input> input, std::string* why,
                                     FileIndex known) {
  if (input->size() == 0)
    *why = "it is empty";
  else if (!HasMagic(input.get(), 0))
    *why = "it is not an MCAP file";
  else
    return std::unique_ptr<Reader>(new Reader(std::move(input), std::move(known)));
  return nullptr;
}

Reader::Reader(std::unique_ptr<Input> input, FileIndex known)
    : input_(std::move(input)), index_(ReadFileIndex(input_.get(), std::move(known))) {}

void Reader::Seek(std::uint64_t log_time) {
  from_ = log_time;
  next_chunk_ = 0;
  open_.clear();
}

/// Returns true if the next chunk may have a message that is earlier than all messages of the open
/// chunks.
bool Reader::WantsNextChunk() const {
  if (next_chunk_ == index_.chunks.size()) return false;
  if (open_.empty()) return true;
  std::size_t size = 0;
  std::uint64_t earliest = UINT64_MAX;
  for (const OpenChunk& chunk : open_) {
    size += chunk.records.size();
    earliest = std::min(earliest, chunk.time());
  }
  return index_.chunks[next_chunk_].start_time <= earliest && open_.size() < kMaxOpenChunks &&
         size < kMaxOpen;
}

/// Returns true if the channel is known. Some writers write a channel only once, so this function
/// also reads the chunks that a seek skipped, until it finds the channel.
bool Reader::Knows(std::uint16_t channel) {
  Bytes records;
  for (; index_.channels.count(channel) == 0; ++learnt_chunks_) {
    if (learnt_chunks_ + 1 >= next_chunk_) return false;
    if (ReadChunk(input_.get(), index_.chunks[learnt_chunks_], &records))
      index_.LearnAll({records.data(), records.size()});
  }
  return true;
}

void Reader::FindMessages(OpenChunk* chunk) {
  const ByteView records{chunk->records.data(), chunk->records.size()};
  std::size_t offset = 0;
  while (const auto record = NextRecord(records, &offset)) {
    if (record->op != Op::kMessage) {
      index_.Learn(*record);
      continue;
    }
    ByteView data;
    const auto header = ParseMessage(record->content, &data);
    if (header && header->log_time >= from_ && Knows(header->channel_id))
      chunk->entries.push_back({header->log_time, record->offset});
  }
  std::stable_sort(chunk->entries.begin(), chunk->entries.end(),
                   [](const Entry& a, const Entry& b) { return a.log_time < b.log_time; });
}

void Reader::OpenNextChunk() {
  const ChunkPlace& place = index_.chunks[next_chunk_++];
  if (place.end_time < from_) return;
  if (learnt_chunks_ + 1 == next_chunk_) ++learnt_chunks_;
  OpenChunk chunk;
  if (!ReadChunk(input_.get(), place, &chunk.records)) {
    ++damaged_chunks_;
    return;
  }
  FindMessages(&chunk);
  if (!chunk.entries.empty()) open_.push_back(std::move(chunk));
}

Reader::OpenChunk* Reader::Earliest() {
  const auto found =
      std::min_element(open_.begin(), open_.end(),
                       [](const OpenChunk& a, const OpenChunk& b) { return a.time() < b.time(); });
  return found == open_.end() ? nullptr : &*found;
}

std::optional<Message> Reader::Next() {
  open_.erase(
      std::remove_if(open_.begin(), open_.end(), [](const OpenChunk& c) { return c.ended(); }),
      open_.end());
  while (WantsNextChunk()) OpenNextChunk();
  OpenChunk* chunk = Earliest();
  if (chunk == nullptr) return std::nullopt;
  std::size_t offset = chunk->entries[chunk->next++].offset;
  const auto record = NextRecord({chunk->records.data(), chunk->records.size()}, &offset);
  Message message;
  message.header = *ParseMessage(record->content, &message.data);
  return message;
}

}  // namespace lidar::mcap
