// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests how far the reader trusts files of other writers.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "src/mcap/chunk.h"
#include "src/mcap/compression.h"
#include "src/mcap/file_index.h"
#include "src/mcap/record_input.h"
#include "tests/core/mcap/memory_file.h"

namespace lidar::mcap {
namespace {

using test::FileMaker;
using test::kSecond;
using test::MemoryInput;
using test::Open;
using test::ReadAll;
using test::View;

ByteView ViewOf(const Bytes& bytes) { return {bytes.data(), bytes.size()}; }

Bytes Begin() { return {kMagic.begin(), kMagic.end()}; }

/// Returns the records of a schema, of the channel `id` and of a message on this channel.
Bytes ChannelWithMessage(std::uint16_t id, std::uint64_t time) {
  Bytes records;
  Append(Schema{1, "s", "ros2msg", ""}, &records);
  Append(Channel{id, 1, "topic " + std::to_string(id), "cdr", {}}, &records);
  Append(MessageHeader{id, 0, time, time}, View("data"), &records);
  return records;
}

void AppendChunk(const Bytes& records, std::uint64_t time, Bytes* file) {
  Append(ChunkHeader{time, time, records.size(), 0, "", records.size()}, ViewOf(records), file);
}

/// A file of zeros, except for its first bytes and its footer.
class HugeInput : public Input {
 public:
  explicit HugeInput(std::uint64_t summary_start) : begin_(Begin()) {
    Append(Footer{summary_start, 0, 0}, &end_);
    end_.insert(end_.end(), kMagic.begin(), kMagic.end());
  }
  std::uint64_t size() const override { return std::uint64_t{1} << 50; }
  bool Read(std::uint64_t offset, std::size_t n, std::uint8_t* to) override {
    if (offset > size() || n > size() - offset) return false;
    most_ = std::max(most_, n);
    const std::uint64_t end = size() - end_.size();
    for (std::size_t i = 0; i < n; ++i, ++offset)
      to[i] = offset < begin_.size() ? begin_[offset] : offset >= end ? end_[offset - end] : 0;
    return true;
  }
  std::size_t most() const { return most_; }

 private:
  Bytes begin_;
  Bytes end_;
  std::size_t most_ = 0;
};

TEST(McapLimits, ARunOfMessagesIsNoLongerThanAChunk) {
  HugeInput input(0);
  ChunkPlace run{};
  run.offset = kMagic.size();
  run.is_run = true;
  Bytes records;
  for (const std::uint64_t size : {kMaxChunk + 1, std::uint64_t{1} << 40}) {
    run.size = size;
    EXPECT_FALSE(ReadChunk(&input, run, &records)) << size;
  }
  EXPECT_EQ(input.most(), 0U);
  run.size = 1'000;
  EXPECT_TRUE(ReadChunk(&input, run, &records));
  EXPECT_EQ(records.size(), 1'000U);
}

TEST(McapLimits, ASummaryOfAPetabyteIsNotRead) {
  HugeInput input(8);
  EXPECT_TRUE(ReadFileIndex(&input).chunks.empty());
  EXPECT_LE(input.most(), kMaxSummary);
}

/// Completes the file with a summary that consists of `records`. The summary has no checksum.
void Close(const Bytes& records, Bytes* file) {
  AppendDataEnd(0, file);
  const std::uint64_t start = file->size();
  file->insert(file->end(), records.begin(), records.end());
  Append(Footer{start, 0, 0}, file);
  file->insert(file->end(), kMagic.begin(), kMagic.end());
}

std::vector<std::uint64_t> Times(Reader* reader) {
  std::vector<std::uint64_t> times;
  for (const auto& message : ReadAll(reader)) times.push_back(message.log_time);
  return times;
}

TEST(McapOfOthers, AChunkThatClaimsMoreThanItsRecordHoldsIsPassedOver) {
  Bytes file = Begin();
  const std::uint64_t at = file.size();
  const Bytes records = ChannelWithMessage(1, 5);
  // A reader that trusts this length would continue to read in the next record.
  Append(ChunkHeader{5, 5, records.size() + 9, 0, "", 0}, ViewOf(records), &file);
  file[at + 41] = static_cast<std::uint8_t>(file[at + 41] + 9);
  AppendChunk(ChannelWithMessage(2, 6), 6, &file);
  const auto reader = Open(file);
  EXPECT_EQ(Times(reader.get()), (std::vector<std::uint64_t>{6}));
  EXPECT_EQ(reader->damaged_chunks(), 0U);
}

TEST(McapOfOthers, ARecordMustEndWithinTheFile) {
  Bytes file = Begin();
  Append(Header{"", ""}, &file);
  MemoryInput whole(file);
  EXPECT_TRUE(RecordAt(&whole, kMagic.size()));
  file.pop_back();
  MemoryInput cut(file);
  EXPECT_FALSE(RecordAt(&cut, kMagic.size()));
}

TEST(McapOfOthers, ChunksMayBeAsLargeAsTheLimitAndNoLarger) {
  for (const bool larger : {false, true}) {
    Bytes file;
    Append(ChunkHeader{1, 2, kMaxChunk + (larger ? 1 : 0), 0, "zstd", 4}, View("bomb"), &file);
    MemoryInput input(file);
    EXPECT_EQ(ReadChunkHeader(&input, *RecordAt(&input, 0)).has_value(), !larger);
  }
}

/// Returns the index of a chunk with the time 5. The chunk begins at `at` and ends at the end of
/// `file`.
ChunkIndex IndexOf(std::uint64_t at, const Bytes& file) {
  ChunkIndex index;
  index.start_time = index.end_time = 5;
  index.offset = at;
  index.size = file.size() - at;
  return index;
}

TEST(McapOfOthers, ChecksumsMayBeLeftOut) {
  const Bytes records = ChannelWithMessage(1, 5);
  Bytes file = Begin();
  const std::uint64_t at = file.size();
  AppendChunk(records, 5, &file);
  Bytes summary;
  Append(Schema{1, "of the summary", "ros2msg", ""}, &summary);
  Append(Channel{1, 1, "topic 1", "cdr", {}}, &summary);
  Append(IndexOf(at, file), &summary);
  Close(summary, &file);
  MemoryInput input(file);
  const FileIndex found = ReadFileIndex(&input);
  EXPECT_TRUE(found.complete);
  EXPECT_EQ(found.schemas.at(1).name, "of the summary");
  const auto reader = Open(file);
  EXPECT_EQ(Times(reader.get()), (std::vector<std::uint64_t>{5}));
  EXPECT_EQ(reader->damaged_chunks(), 0U);
}

TEST(McapOfOthers, AChunkIsReadOnceHoweverOftenItIsIndexed) {
  Bytes file = Begin();
  const std::uint64_t at = file.size();
  AppendChunk(ChannelWithMessage(1, 5), 5, &file);
  Bytes summary;
  Append(Schema{1, "s", "ros2msg", ""}, &summary);
  Append(Channel{1, 1, "topic 1", "cdr", {}}, &summary);
  ChunkIndex index = IndexOf(at, file);
  for (std::uint64_t i = 0; i < 60; ++i) {
    index.start_time = i % 6;
    Append(index, &summary);
  }
  // This index claims that a second chunk begins within the first one.
  ChunkIndex inside = IndexOf(at + 9, file);
  Append(inside, &summary);
  Close(summary, &file);
  const auto reader = Open(file);
  EXPECT_EQ(reader->index().chunks.size(), 1U);
  EXPECT_EQ(Times(reader.get()), (std::vector<std::uint64_t>{5}));

  Bytes liar = Begin();
  AppendChunk(ChannelWithMessage(1, 5), 5, &liar);
  summary.clear();
  Append(Schema{1, "s", "ros2msg", ""}, &summary);
  Append(Channel{1, 1, "topic 1", "cdr", {}}, &summary);
  index = IndexOf(at, liar);
  index.size = 10;
  Append(index, &summary);
  Close(summary, &liar);
  const auto lied_to = Open(liar);
  EXPECT_TRUE(Times(lied_to.get()).empty());
  EXPECT_EQ(lied_to->damaged_chunks(), 1U);
}

TEST(McapOfOthers, ASummaryThatLacksChunksChannelsOrSchemasIsNoIndex) {
  for (const bool channels : {false, true}) {
    for (const bool chunks : {false, true}) {
      Bytes file = Begin();
      const std::uint64_t at = file.size();
      AppendChunk(ChannelWithMessage(1, 5), 5, &file);
      Bytes summary;
      if (channels) Append(Channel{1, 1, "topic 1", "cdr", {}}, &summary);
      if (chunks) Append(IndexOf(at, file), &summary);
      Close(summary, &file);
      MemoryInput input(file);
      const FileIndex found = ReadFileIndex(&input);
      EXPECT_TRUE(found.complete);
      EXPECT_EQ(found.chunks.size(), 1U);
      EXPECT_EQ(found.channels.size(), 1U);
      EXPECT_EQ(found.schemas.size(), 1U);
    }
  }
}

TEST(McapOfOthers, AFileMayBeClosedWithoutASummary) {
  Bytes file = Begin();
  AppendChunk(ChannelWithMessage(1, 5), 5, &file);
  Append(Footer{}, &file);
  file.insert(file.end(), kMagic.begin(), kMagic.end());
  MemoryInput input(file);
  const FileIndex found = ReadFileIndex(&input);
  EXPECT_TRUE(found.complete);
  EXPECT_EQ(found.chunks.size(), 1U);
}

TEST(McapOfOthers, AnIndexThatPointsOutOfTheFileIsNotTaken) {
  Bytes file = Begin();
  const std::uint64_t at = file.size();
  AppendChunk(ChannelWithMessage(1, 5), 5, &file);
  Bytes summary;
  Append(Channel{1, 1, "topic 1", "cdr", {}}, &summary);
  ChunkIndex index;
  index.size = file.size() - at;
  for (const std::uint64_t offset : {at, std::uint64_t{1'000'000}, UINT64_MAX}) {
    index.offset = offset;
    Append(index, &summary);
  }
  Close(summary, &file);
  MemoryInput input(file);
  EXPECT_EQ(ReadFileIndex(&input).chunks.size(), 1U);
}

TEST(McapOfOthers, ASummaryWhoseChecksumDoesNotFitIsNoIndex) {
  FileMaker maker(WriterSettings{});
  const auto a = maker.AddChannel("a");
  for (std::uint64_t i = 0; i < 3; ++i) ASSERT_TRUE(maker.Add(a, i * 2 * kSecond, "x"));
  ASSERT_TRUE(maker.writer().Finish());
  const std::size_t summary = maker.ends()[2];  // the offset after the last chunk
  const Bytes& whole = maker.file();
  for (std::size_t at = summary + 40; at + 40 < whole.size(); at += 7) {
    Bytes file = whole;
    file[at] ^= 0x10;
    const auto reader = Open(file);
    EXPECT_FALSE(reader->index().complete) << at;
    EXPECT_EQ(ReadAll(reader.get()).size(), 3U) << at;
  }
}

TEST(McapOfOthers, ChunksWithoutMessagesHaveNoTime) {
  FileIndex index;
  index.chunks = {{0, 0, 8, 10, false}, {3, 5, 18, 10, false}, {4, 4, 28, 10, false}};
  EXPECT_EQ(index.start_time(), 3U);
  EXPECT_EQ(index.end_time(), 5U);
}

TEST(McapOfOthers, ChannelsAndSchemasAreLearntOnceAndWithinALimit) {
  FileIndex index;
  const auto learn = [&](std::uint16_t id, std::size_t size) {
    Bytes bytes;
    Append(Schema{id, "s", "ros2msg", std::string(size, 'x')}, &bytes);
    std::size_t offset = 0;
    return index.Learn(*NextRecord(ViewOf(bytes), &offset));
  };
  EXPECT_FALSE(learn(0, 10));  // The id 0 means that there is no schema.
  EXPECT_TRUE(learn(1, 10));
  const std::uint64_t one = index.catalogue_size;
  EXPECT_GT(one, 10U);
  EXPECT_FALSE(learn(1, 10));
  EXPECT_EQ(index.catalogue_size, one);
  EXPECT_TRUE(learn(2, kMaxCatalogue / 2));
  EXPECT_FALSE(learn(3, kMaxCatalogue / 2));
  EXPECT_EQ(index.schemas.size(), 2U);
}

TEST(McapOfOthers, MessagesOutsideOfChunksMayBeInAnyOrder) {
  Bytes file = Begin();
  Append(Schema{1, "s", "ros2msg", ""}, &file);
  Append(Channel{1, 1, "t", "cdr", {}}, &file);
  for (const std::uint64_t time : {5U, 3U, 9U, 7U})
    Append(MessageHeader{1, 0, time, time}, View("x"), &file);
  const auto reader = Open(file);
  EXPECT_EQ(reader->index().start_time(), 3U);
  EXPECT_EQ(reader->index().end_time(), 9U);
  EXPECT_EQ(Times(reader.get()), (std::vector<std::uint64_t>{3, 5, 7, 9}));
  reader->Seek(8);
  EXPECT_EQ(Times(reader.get()), (std::vector<std::uint64_t>{9}));
}

TEST(McapOfOthers, ManyMessagesOutsideOfChunksAreReadInPiecesOfAMebibyte) {
  Bytes file = Begin();
  Append(Schema{1, "s", "ros2msg", ""}, &file);
  Append(Channel{1, 1, "t", "cdr", {}}, &file);
  for (std::uint64_t time = 1; time <= 8; ++time)
    Append(MessageHeader{1, 0, time, time}, View(std::string(300'000, 'x')), &file);
  const auto reader = Open(file);
  ASSERT_EQ(reader->index().chunks.size(), 3U);
  for (const ChunkPlace& piece : reader->index().chunks) EXPECT_LE(piece.size, 1U << 20);
  EXPECT_EQ(Times(reader.get()), (std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(McapOfOthers, AMessageThatIsTooShortIsPassedOver) {
  Bytes file = Begin();
  Append(Schema{1, "s", "ros2msg", ""}, &file);
  Append(Channel{1, 1, "t", "cdr", {}}, &file);
  for (const std::uint64_t time : {5U, 7U}) {
    const Bytes three = {static_cast<std::uint8_t>(Op::kMessage), 3, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3};
    file.insert(file.end(), three.begin(), three.end());
    Append(MessageHeader{1, 0, time, time}, View("x"), &file);
  }
  const auto reader = Open(file);
  EXPECT_EQ(Times(reader.get()), (std::vector<std::uint64_t>{5, 7}));
}

TEST(McapOfOthers, TheChannelsOfTheFirstChunksAreKnownAtOnceOthersWithTheirMessages) {
  Bytes file = Begin();
  for (std::uint16_t id = 1; id <= 6; ++id) AppendChunk(ChannelWithMessage(id, id), id, &file);
  const auto reader = Open(file);
  EXPECT_EQ(reader->index().channels.size(), 4U);
  EXPECT_EQ(ReadAll(reader.get()).size(), 6U);
  EXPECT_EQ(reader->index().channels.size(), 6U);
}

TEST(McapOfOthers, AChannelMayStandOnceInAChunkThatASeekPassesOver) {
  Bytes file = Begin();
  for (std::uint16_t id = 1; id <= 6; ++id) AppendChunk(ChannelWithMessage(id, id), id, &file);
  Bytes message;
  Append(MessageHeader{5, 0, 9, 9}, View("data"), &message);
  AppendChunk(message, 9, &file);
  const auto reader = Open(file);
  reader->Seek(8);
  EXPECT_EQ(Times(reader.get()), (std::vector<std::uint64_t>{9}));
  reader->Seek(4);
  EXPECT_EQ(Times(reader.get()), (std::vector<std::uint64_t>{4, 5, 6, 9}));
}

TEST(McapOfOthers, MessagesOfNoChannelAreLeftOut) {
  Bytes records = ChannelWithMessage(1, 5);
  Append(MessageHeader{2, 0, 6, 6}, View("whose?"), &records);
  Append(MessageHeader{1, 0, 7, 7}, View("data"), &records);
  Bytes file = Begin();
  AppendChunk(records, 5, &file);
  Bytes without_chunk = Begin();
  without_chunk.insert(without_chunk.end(), records.begin(), records.end());
  for (const Bytes& bytes : {file, without_chunk}) {
    const auto reader = Open(bytes);
    EXPECT_EQ(Times(reader.get()), (std::vector<std::uint64_t>{5, 7}));
  }
}

TEST(McapOfOthers, AChannelWhoseMetadataAreCutIsNone) {
  Bytes bytes;
  Append(Channel{1, 1, "t", "cdr", {{"key", "value"}}}, &bytes);
  Bytes content(bytes.begin() + 9, bytes.end());
  ASSERT_TRUE(ParseChannel(ViewOf(content)));
  content[content.size() - 9] = 6;  // changes the length of "value"
  EXPECT_FALSE(ParseChannel(ViewOf(content)));
}

TEST(Mcap, CompressionMustPayAndItsFramesMustEnd) {
  std::mt19937 random(5);
  for (const Compression compression : {Compression::kLz4, Compression::kZstd}) {
    for (const std::size_t zeros : {3'000U, 10'000U}) {
      std::string bytes(100'000, '\0');
      for (std::size_t i = zeros; i < bytes.size(); ++i) bytes[i] = static_cast<char>(random());
      Bytes packed, out;
      ASSERT_EQ(Compress(compression, View(bytes), &packed), zeros == 10'000U);
      packed.push_back(0);
      EXPECT_FALSE(Decompress(NameOf(compression), ViewOf(packed), bytes.size(), &out));
    }
  }
}

TEST(Mcap, AChunkHoldsTheTimesOfItsMessagesWhateverTheirOrder) {
  FileMaker maker(WriterSettings{});
  const auto a = maker.AddChannel("a");
  for (const std::uint64_t time : {500U, 300U, 400U}) maker.Add(a, 10 * kSecond + time, "x");
  EXPECT_EQ(maker.writer().chunks(), 0U);  // A message with an earlier time does not end the chunk.
  ASSERT_TRUE(maker.writer().Flush());
  maker.Add(a, kSecond, "x");
  ASSERT_TRUE(maker.writer().Finish());
  EXPECT_EQ(maker.writer().statistics().start_time, kSecond);
  EXPECT_EQ(maker.writer().statistics().end_time, 10 * kSecond + 500);
  const auto reader = Open(maker.file());
  ASSERT_EQ(reader->index().chunks.size(), 2U);
  EXPECT_EQ(reader->index().chunks[1].start_time, 10 * kSecond + 300);
  EXPECT_EQ(reader->index().chunks[1].end_time, 10 * kSecond + 500);
  EXPECT_EQ(Times(reader.get()),
            (std::vector<std::uint64_t>{kSecond, 10 * kSecond + 300, 10 * kSecond + 400,
                                        10 * kSecond + 500}));
}

TEST(Mcap, AChunkIsNoLargerThanAReaderTakes) {
  WriterSettings settings;
  settings.chunk_size = std::size_t{64} << 20;
  FileMaker maker(settings);
  const auto a = maker.AddChannel("a");
  const std::string cloud(std::size_t{70} << 20, 'x');
  ASSERT_TRUE(maker.Add(a, 1, std::string(std::size_t{60} << 20, 'x')));
  ASSERT_TRUE(maker.Add(a, 2, cloud));
  ASSERT_TRUE(maker.writer().Finish());
  const auto reader = Open(maker.file());
  EXPECT_EQ(Times(reader.get()), (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(reader->damaged_chunks(), 0U);
}

TEST(Mcap, AnEndThatLostItsLastChunkIsAFailure) {
  Catalogue catalogue;
  Channel channel;
  channel.schema_id = catalogue.AddSchema({0, "s", "ros2msg", ""});
  const auto id = catalogue.AddChannel(channel);
  int pieces = 0;
  Writer writer({}, &catalogue, [&](ByteView) { return ++pieces != 2; });
  ASSERT_TRUE(writer.Add({id, 0, 1, 1}, View("kept")));
  ASSERT_TRUE(writer.Flush());
  ASSERT_TRUE(writer.Add({id, 0, 2, 2}, View("lost")));
  EXPECT_FALSE(writer.Finish());
  EXPECT_EQ(pieces, 3);  // The writer still writes the end of the file.
}

TEST(Mcap, ThereAreAsManyChannelsAsNumbersForThem) {
  Catalogue catalogue;
  for (std::uint32_t i = 1; i <= 0xFFFF; ++i) ASSERT_EQ(catalogue.AddChannel({}), i);
  for (int more = 0; more < 2; ++more) EXPECT_EQ(catalogue.AddChannel({}), 0);
}

TEST(McapWriter, ChannelsTakeNoMoreThanAReaderTakes) {
  Catalogue catalogue;
  Channel large;
  large.topic = "/t";
  large.metadata = {{"caps", std::string(100'000, 'x')}};
  std::uint16_t channels = 0;
  while (channels < 1'000 && catalogue.AddChannel(large) != 0) ++channels;
  EXPECT_GE(channels, 50);
  EXPECT_LE(channels, 80) << "8 MiB in all";
}

}  // namespace
}  // namespace lidar::mcap
