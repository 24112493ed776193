// SPDX-License-Identifier: LGPL-2.1-or-later
// Scans a file that has no summary, because the file is incomplete or its writer does not write
// one.
#include <algorithm>
#include <optional>
#include <utility>

#include "src/mcap/chunk.h"
#include "src/mcap/file_index.h"

namespace lidar::mcap {
namespace {

constexpr std::uint64_t kMaxRun = std::uint64_t{1} << 20;  // bytes
constexpr int kChunksToLearn = 4;  // reading a later chunk's messages also finds its channels

class Scanner {
 public:
  Scanner(Input* input, FileIndex known) : input_(*input), index_(std::move(known)) {}

  FileIndex Run() {
    std::uint64_t offset = Begin();
    while (const auto record = RecordAt(&input_, offset)) {
      if (!Take(*record, offset)) break;
      offset = record->end();
    }
    EndRun();
    auto& chunks = index_.chunks;
    std::stable_sort(chunks.begin(), chunks.end(), [](const ChunkPlace& a, const ChunkPlace& b) {
      return a.start_time < b.start_time;
    });
    return std::move(index_);
  }

 private:
  /// Returns the end of the known records. Forgets the known records if another file has replaced
  /// the file.
  std::uint64_t Begin() {
    const auto last = std::max_element(
        index_.chunks.begin(), index_.chunks.end(),
        [](const ChunkPlace& a, const ChunkPlace& b) { return a.offset < b.offset; });
    if (last == index_.chunks.end()) return kMagic.size();
    const auto record = RecordAt(&input_, last->offset);
    const auto header = record ? ReadChunkHeader(&input_, *record) : std::nullopt;
    if (header && record->end() == last->offset + last->size &&
        header->start_time == last->start_time && header->end_time == last->end_time)
      return record->end();
    index_ = {};
    return kMagic.size();
  }

  /// Adds a record to the index. Returns false at the end of the data section.
  bool Take(const RecordPlace& record, std::uint64_t offset) {
    switch (record.op) {
      case Op::kChunk:
        EndRun();
        return TakeChunk(record, offset);
      case Op::kMessage:
        return TakeMessage(record, offset);
      case Op::kSchema:
      case Op::kChannel:
        EndRun();
        if (record.size > kMaxCatalogue || !ReadContent(&input_, record, record.size, &content_))
          return false;
        index_.Learn({record.op, {content_.data(), content_.size()}, 0});
        return true;
      case Op::kDataEnd:
      case Op::kFooter:
        return false;
      default:
        EndRun();
        return true;
    }
  }

  bool TakeChunk(const RecordPlace& record, std::uint64_t offset) {
    const auto header = ReadChunkHeader(&input_, record);
    if (!header) return true;  // the records after it may be intact
    index_.chunks.push_back(
        {header->start_time, header->end_time, offset, record.end() - offset, false});
    if (learned_ == kChunksToLearn) return true;
    ++learned_;
    if (ReadChunk(&input_, index_.chunks.back(), &content_))
      index_.LearnAll({content_.data(), content_.size()});
    return true;
  }

  bool TakeMessage(const RecordPlace& record, std::uint64_t offset) {
    ByteView data;
    if (!ReadContent(&input_, record, MessageHeader::kSize, &content_)) return false;
    const auto message = ParseMessage({content_.data(), content_.size()}, &data);
    if (!message) return true;
    if (run_ && record.end() - run_->offset > kMaxRun) EndRun();
    if (!run_) run_ = ChunkPlace{message->log_time, message->log_time, offset, 0, true};
    run_->start_time = std::min(run_->start_time, message->log_time);
    run_->end_time = std::max(run_->end_time, message->log_time);
    run_->size = record.end() - run_->offset;
    return true;
  }

  void EndRun() {
    if (run_) index_.chunks.push_back(*run_);
    run_.reset();
  }

  Input& input_;
  FileIndex index_;
  std::optional<ChunkPlace> run_;
  Bytes content_;
  int learned_ = 0;
};

}  // namespace

FileIndex ScanFile(Input* input, FileIndex known) { return Scanner(input, std::move(known)).Run(); }

}  // namespace lidar::mcap
