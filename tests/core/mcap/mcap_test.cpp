// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "src/base/byte_writer.h"
#include "tests/core/mcap/memory_file.h"

namespace lidar::mcap {
namespace {

using test::FileMaker;
using test::Kept;
using test::kSecond;
using test::Open;
using test::ReadAll;

class Compressed : public ::testing::TestWithParam<Compression> {
 protected:
  static WriterSettings Settings() {
    WriterSettings settings;
    settings.compression = GetParam();
    return settings;
  }
};

/// Records `count` messages, 100 ms apart, on two topics. Returns the messages.
std::vector<Kept> Record(FileMaker* maker, int count, std::size_t size = 200) {
  const auto points = maker->AddChannel("points");
  const auto imu = maker->AddChannel("imu");
  std::vector<Kept> all;
  for (int i = 0; i < count; ++i) {
    const std::uint64_t time = 5 * kSecond + static_cast<std::uint64_t>(i) * kSecond / 10;
    const std::string data(size, static_cast<char>('a' + i % 26));
    EXPECT_TRUE(maker->Add(i % 3 == 0 ? imu : points, time, data));
    all.push_back({i % 3 == 0 ? "imu" : "points", time, time + 7, data});
  }
  return all;
}

TEST_P(Compressed, AllMessagesComeBack) {
  FileMaker maker(Settings());
  const auto written = Record(&maker, 50);
  ASSERT_TRUE(maker.writer().Finish());
  const auto reader = Open(maker.file());
  ASSERT_NE(reader, nullptr);
  EXPECT_TRUE(reader->index().complete);
  EXPECT_EQ(reader->index().chunks.size(), 5U);  // Each chunk has one second.
  EXPECT_EQ(reader->index().start_time(), written.front().log_time);
  EXPECT_EQ(reader->index().end_time(), written.back().log_time);
  EXPECT_EQ(reader->index().channels.at(1).metadata.at("caps"), "of points");
  EXPECT_EQ(reader->index().schemas.at(1).text, "uint8[] data");
  EXPECT_EQ(ReadAll(reader.get()), written);
  EXPECT_EQ(reader->damaged_chunks(), 0U);
}

TEST_P(Compressed, SeekGoesToTheFirstMessageNotBefore) {
  FileMaker maker(Settings());
  const auto written = Record(&maker, 50);
  ASSERT_TRUE(maker.writer().Finish());
  const auto reader = Open(maker.file());
  for (const std::size_t i : {49U, 0U, 23U, 10U}) {
    reader->Seek(written[i].log_time);
    EXPECT_EQ(ReadAll(reader.get()), std::vector<Kept>(&written[i], written.data() + 50)) << i;
    reader->Seek(written[i].log_time + 1);
    EXPECT_EQ(ReadAll(reader.get()).size(), 49 - i) << i;
  }
}

TEST_P(Compressed, AFileThatBrokeOffGivesEveryWholeChunk) {
  FileMaker maker(Settings());
  const auto written = Record(&maker, 30, 20);
  ASSERT_TRUE(maker.writer().Finish());
  const auto& ends = maker.ends();  // the sizes of the file after three chunks and after the index
  ASSERT_EQ(ends.size(), 4U);
  for (std::size_t size = kMagic.size(); size < maker.file().size(); ++size) {
    const auto reader =
        Open(Bytes(maker.file().begin(), maker.file().begin() + static_cast<long>(size)));
    ASSERT_NE(reader, nullptr);
    EXPECT_FALSE(reader->index().complete);
    // A chunk can be read even if the message indexes after it are missing.
    const auto whole = static_cast<std::size_t>(
        std::count_if(ends.begin(), ends.end() - 1, [&](std::size_t end) { return end <= size; }));
    const auto read = ReadAll(reader.get());
    ASSERT_GE(read.size(), 10 * whole) << size;
    ASSERT_LE(read.size(), 10 * (whole + 1)) << size;
    ASSERT_TRUE(std::equal(read.begin(), read.end(), written.begin())) << size;
  }
}

TEST_P(Compressed, ADamagedChunkIsLeftOutAndCounted) {
  FileMaker maker(Settings());
  const auto written = Record(&maker, 30);
  ASSERT_TRUE(maker.writer().Finish());
  Bytes file = maker.file();
  const auto index = Open(file)->index().chunks[1];
  file[index.offset + index.size - 30] ^= 0x55;
  const auto reader = Open(file);
  const auto read = ReadAll(reader.get());
  EXPECT_EQ(read.size(), 20U);
  EXPECT_EQ(read[10], written[20]);
  EXPECT_EQ(reader->damaged_chunks(), 1U);
}

INSTANTIATE_TEST_SUITE_P(Mcap, Compressed,
                         ::testing::Values(Compression::kNone, Compression::kLz4,
                                           Compression::kZstd));

TEST(Mcap, WhatDoesNotGetSmallerIsStoredAsItIs) {
  std::mt19937 random(3);
  std::string noise(100'000, '\0');
  for (char& c : noise) c = static_cast<char>(random());
  Bytes out;
  EXPECT_FALSE(Compress(Compression::kZstd, test::View(noise), &out));
  EXPECT_FALSE(Compress(Compression::kLz4, test::View(noise), &out));
  const std::string same(100'000, 'x');
  EXPECT_TRUE(Compress(Compression::kZstd, test::View(same), &out));
  EXPECT_LT(out.size(), 1'000U);
}

TEST(Mcap, ACompressedChunkMustBeAsLongAsItSays) {
  const std::string text(10'000, 'x');
  for (const Compression compression : {Compression::kLz4, Compression::kZstd}) {
    Bytes packed, out;
    ASSERT_TRUE(Compress(compression, test::View(text), &packed));
    const auto name = NameOf(compression);
    EXPECT_TRUE(Decompress(name, {packed.data(), packed.size()}, 10'000, &out));
    EXPECT_FALSE(Decompress(name, {packed.data(), packed.size()}, 9'999, &out));
    EXPECT_FALSE(Decompress(name, {packed.data(), packed.size()}, 10'001, &out));
    EXPECT_FALSE(Decompress(name, {packed.data(), packed.size() - 1}, 10'000, &out));
    EXPECT_FALSE(Decompress("bz2", {packed.data(), packed.size()}, 10'000, &out));
  }
}

TEST(Mcap, NothingIsWrittenWithoutAMessage) {
  FileMaker maker(WriterSettings{});
  maker.AddChannel("points");
  EXPECT_TRUE(maker.writer().Finish());
  EXPECT_TRUE(maker.file().empty());
}

TEST(Mcap, AChunkEndsByItsSizeAndByItsTime) {
  WriterSettings settings;
  settings.chunk_size = 1'000;
  FileMaker by_size(settings);
  Record(&by_size, 12, 400);
  EXPECT_EQ(by_size.writer().chunks(), 4U);
  settings.chunk_duration = std::chrono::milliseconds(200);
  settings.chunk_size = 1U << 20;
  FileMaker by_time(settings);
  Record(&by_time, 12, 400);
  EXPECT_EQ(by_time.writer().chunks(), 5U);
}

TEST(Mcap, AFullDiskCostsOneChunkAndTheFileIsClosedInOrder) {
  FileMaker maker(WriterSettings{});
  const auto points = maker.AddChannel("points");
  for (std::uint64_t i = 0; i < 15; ++i) ASSERT_TRUE(maker.Add(points, i * kSecond / 10, "here"));
  maker.FillDisk();
  bool written = true;
  for (std::uint64_t i = 15; i < 21; ++i)
    written = maker.Add(points, i * kSecond / 10, "lost") && written;
  EXPECT_FALSE(written);
  maker.FreeDisk();
  EXPECT_TRUE(maker.writer().Finish());
  const auto reader = Open(maker.file());
  EXPECT_TRUE(reader->index().complete);
  EXPECT_EQ(ReadAll(reader.get()).size(), 11U);
}

TEST(Mcap, ChunksThatOverlapAreMerged) {
  FileMaker maker(WriterSettings{});
  const auto a = maker.AddChannel("a");
  const auto b = maker.AddChannel("b");
  // All messages of one topic are written before those of the other, as if two files had been read
  // one after the other.
  for (std::uint64_t i = 0; i < 40; ++i) maker.Add(a, i * kSecond / 10, "a");
  for (std::uint64_t i = 0; i < 40; ++i) maker.Add(b, i * kSecond / 10 + 1, "b");
  ASSERT_TRUE(maker.writer().Finish());
  const auto reader = Open(maker.file());
  std::uint64_t last = 0;
  const auto read = ReadAll(reader.get());
  ASSERT_EQ(read.size(), 80U);
  for (const Kept& message : read) {
    EXPECT_GE(message.log_time, last);
    last = message.log_time;
  }
}

TEST(Mcap, MessagesOutsideOfChunksAreRead) {
  Bytes file(kMagic.begin(), kMagic.end());
  Append(Header{"", "another writer"}, &file);
  Append(Schema{1, "s", "ros2msg", ""}, &file);
  Append(Channel{5, 1, "points", "cdr", {}}, &file);
  for (std::uint64_t i = 0; i < 10; ++i)
    Append(MessageHeader{5, 0, i, i}, test::View(std::string(300'000, 'x')), &file);
  AppendDataEnd(0, &file);
  Append(Footer{}, &file);
  file.insert(file.end(), kMagic.begin(), kMagic.end());
  const auto reader = Open(file);
  EXPECT_EQ(ReadAll(reader.get()).size(), 10U);
  reader->Seek(8);
  EXPECT_EQ(ReadAll(reader.get()).size(), 2U);
}

TEST(Mcap, AFileWithoutASummaryIsAsLongAsItsChunks) {
  FileMaker maker(WriterSettings{});
  const auto a = maker.AddChannel("a");
  // The newest message is written before the others.
  for (const std::uint64_t second : {7U, 3U, 5U}) {
    maker.Add(a, second * kSecond, "x");
    ASSERT_TRUE(maker.writer().Flush());
  }
  for (const bool finished : {false, true}) {
    if (finished) {
      ASSERT_TRUE(maker.writer().Finish());
    }
    const auto reader = Open(maker.file());
    EXPECT_EQ(reader->index().complete, finished);
    EXPECT_EQ(reader->index().start_time(), 3 * kSecond);
    EXPECT_EQ(reader->index().end_time(), 7 * kSecond);
    // The channel is known before a chunk is read.
    EXPECT_EQ(reader->index().channels.count(a), 1U);
    const auto read = ReadAll(reader.get());
    ASSERT_EQ(read.size(), 3U);
    EXPECT_EQ(read[0].log_time, 3 * kSecond);
    EXPECT_EQ(read[2].log_time, 7 * kSecond);
  }
}

TEST(Mcap, ASeekTakesTheMessageOfItsTime) {
  FileMaker maker(WriterSettings{});
  Record(&maker, 50);
  ASSERT_TRUE(maker.writer().Finish());
  const auto reader = Open(maker.file());
  for (const std::uint64_t time : {5 * kSecond, 6 * kSecond, 99 * kSecond / 10}) {
    reader->Seek(time);
    ASSERT_TRUE(reader->Next());
    reader->Seek(time);
    EXPECT_EQ(reader->Next()->header.log_time, time);
    reader->Seek(time + 1);
    const auto after = reader->Next();
    if (time < 9 * kSecond) {
      ASSERT_TRUE(after);
      EXPECT_EQ(after->header.log_time, time + kSecond / 10);
    } else {
      EXPECT_FALSE(after);
    }
  }
}

TEST(Mcap, SaysWhyAFileIsNone) {
  std::string why;
  EXPECT_EQ(Reader::Open(std::make_unique<test::MemoryInput>(Bytes()), &why), nullptr);
  EXPECT_EQ(why, "it is empty");
  EXPECT_EQ(Reader::Open(std::make_unique<test::MemoryInput>(Bytes(100, 'x')), &why), nullptr);
  EXPECT_EQ(why, "it is not an MCAP file");
}

TEST(Mcap, AChunkThatEndsBeforeItsBeginHasNoNegativeDuration) {
  for (const bool indexed : {false, true}) {
    Bytes file(kMagic.begin(), kMagic.end());
    const std::uint64_t offset = file.size();
    Append(ChunkHeader{7 * kSecond, 3 * kSecond, 1, 0, "", 1}, test::View("x"), &file);
    const std::uint64_t size = file.size() - offset;
    const std::uint64_t summary = file.size();
    if (indexed) {
      Append(Channel{1, 0, "points", "cdr", {}}, &file);
      Append(ChunkIndex{7 * kSecond, 3 * kSecond, offset, size, {}, 0, "", 1, 1}, &file);
      Append(Footer{summary, 0, 0}, &file);
      file.insert(file.end(), kMagic.begin(), kMagic.end());
    }
    const auto reader = Open(file);
    ASSERT_EQ(reader->index().chunks.size(), 1U);
    EXPECT_EQ(reader->index().complete, indexed);
    EXPECT_GE(reader->index().end_time(), reader->index().start_time());
  }
}

TEST(Mcap, AHugeChunkIsNotBelieved) {
  for (const std::uint64_t claimed : {kMaxChunk + 1, UINT64_MAX}) {
    Bytes file(kMagic.begin(), kMagic.end());
    Append(ChunkHeader{1, 2, claimed, 0, "zstd", 4}, test::View("bomb"), &file);
    const auto reader = Open(file);
    EXPECT_FALSE(reader->Next());
  }
}

/// The expected bytes follow from the specification. They were not made by the project's writer.
TEST(Mcap, RecordsAreThoseOfTheSpecification) {
  Bytes out;
  Append(MessageHeader{0x0102, 3, 4, 5}, test::View("hi"), &out);
  const Bytes message = {5, 24, 0, 0, 0, 0, 0, 0, 0, 2, 1, 3, 0, 0, 0,   4,  0,
                         0, 0,  0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 'h', 'i'};
  EXPECT_EQ(out, message);
  out.clear();
  Append(Channel{1, 2, "t", "c", {{"k", "v"}}}, &out);
  const Bytes channel = {4, 28, 0, 0,   0,  0, 0, 0, 0, 1, 0, 2, 0,   1, 0, 0, 0, 't', 1,
                         0, 0,  0, 'c', 10, 0, 0, 0, 1, 0, 0, 0, 'k', 1, 0, 0, 0, 'v'};
  EXPECT_EQ(out, channel);
  out.clear();
  Append(ChunkHeader{1, 2, 3, 4, "lz4", 1}, test::View("x"), &out);
  const Bytes chunk = {6, 44, 0, 0, 0, 0,   0,   0,   0, 1, 0, 0, 0, 0, 0, 0, 0,  2,
                       0, 0,  0, 0, 0, 0,   0,   3,   0, 0, 0, 0, 0, 0, 0, 4, 0,  0,
                       0, 3,  0, 0, 0, 'l', 'z', '4', 1, 0, 0, 0, 0, 0, 0, 0, 'x'};
  EXPECT_EQ(out, chunk);
}

/// If any bytes are damaged, the reader must return neither more messages nor messages of a wrong
/// size.
TEST(Mcap, DamageAnywhereIsSurvived) {
  FileMaker maker(WriterSettings{});
  Record(&maker, 30, 40);
  ASSERT_TRUE(maker.writer().Finish());
  std::mt19937 random(7);
  for (int round = 0; round < 500; ++round) {
    Bytes file = maker.file();
    for (int flips = 0; flips < 3; ++flips)
      file[random() % file.size()] = static_cast<std::uint8_t>(random());
    const auto reader = Open(file);
    if (reader == nullptr) continue;
    ASSERT_LE(ReadAll(reader.get()).size(), 90U);
    reader->Seek(6 * kSecond);
    ASSERT_LE(ReadAll(reader.get()).size(), 90U);
  }
}

}  // namespace
}  // namespace lidar::mcap
