// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads a file record by record as the specification (https://mcap.dev/spec) says, without the
// project's reader. Each statement of a record about other records must be true.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>

#include "src/base/crc.h"
#include "tests/core/mcap/memory_file.h"

namespace lidar::mcap {
namespace {

using test::kSecond;

struct Walked {
  std::uint8_t op = 0;
  std::uint64_t offset = 0;
  std::uint64_t size = 0;  // including opcode and length
  ByteView content;
};

std::vector<Walked> Walk(ByteView bytes, std::uint64_t from) {
  std::vector<Walked> records;
  ByteReader r(bytes.data + from, bytes.size - from);
  while (r.remaining() > 0) {
    Walked record;
    record.offset = from + r.position();
    record.op = r.U8();
    record.content = r.Bytes(static_cast<std::size_t>(r.Le64()));
    record.size = 9 + record.content.size;
    EXPECT_TRUE(r.ok());
    if (!r.ok()) break;
    records.push_back(record);
  }
  return records;
}

std::string Text(ByteReader* r) {
  const ByteView text = r->Bytes(r->Le32());
  return {text.begin(), text.end()};
}

std::map<std::uint16_t, std::uint64_t> Map(ByteReader* r) {
  std::map<std::uint16_t, std::uint64_t> map;
  ByteReader entries(r->Bytes(r->Le32()));
  while (entries.remaining() > 0) {
    const std::uint16_t key = entries.Le16();
    map[key] = entries.Le64();
  }
  EXPECT_TRUE(entries.ok());
  return map;
}

struct Chunk {
  Walked record;
  std::uint64_t start = 0;
  std::uint64_t end = 0;
  ByteView messages;
  std::map<std::uint16_t, std::uint64_t> index_offsets;
  std::uint64_t indexes_size = 0;
};

class Layout : public ::testing::Test {
 protected:
  void SetUp() override {
    WriterSettings settings;
    settings.compression = Compression::kNone;
    test::FileMaker maker(settings);
    const auto a = maker.AddChannel("a");
    const auto b = maker.AddChannel("b");
    maker.AddChannel("silent");
    for (std::uint64_t i = 0; i < 25; ++i)
      ASSERT_TRUE(maker.Add(i % 3 == 0 ? b : a, (i + 5) * kSecond / 10, std::string(i + 1, 'x')));
    ASSERT_TRUE(maker.writer().Finish());
    file = maker.file();
    records = Walk({file.data(), file.size() - 8}, 8);
    for (const Walked& record : records) {
      if (record.op == 6) ReadChunk(record);
      if (record.op == 7) ReadIndex(record);
    }
    a_ = a;
    b_ = b;
  }

  void ReadChunk(const Walked& record) {
    Chunk chunk;
    chunk.record = record;
    ByteReader r(record.content);
    chunk.start = r.Le64();
    chunk.end = r.Le64();
    const std::uint64_t size = r.Le64();
    const std::uint32_t crc = r.Le32();
    EXPECT_EQ(Text(&r), "");
    chunk.messages = r.Bytes(static_cast<std::size_t>(r.Le64()));
    EXPECT_TRUE(r.ok());
    EXPECT_EQ(r.remaining(), 0U);
    EXPECT_EQ(chunk.messages.size, size);
    EXPECT_EQ(Crc32(chunk.messages), crc);
    chunks.push_back(chunk);
  }

  void ReadIndex(const Walked& record) {
    ASSERT_FALSE(chunks.empty());
    Chunk& chunk = chunks.back();
    ByteReader r(record.content);
    const std::uint16_t channel = r.Le16();
    chunk.index_offsets[channel] = record.offset;
    chunk.indexes_size += record.size;
    ByteReader entries(r.Bytes(r.Le32()));
    EXPECT_EQ(r.remaining(), 0U);
    while (entries.remaining() > 0) {
      const std::uint64_t time = entries.Le64();
      const auto offset = static_cast<std::size_t>(entries.Le64());
      ASSERT_LT(offset, chunk.messages.size);
      ByteReader message(chunk.messages.data + offset, chunk.messages.size - offset);
      EXPECT_EQ(message.U8(), 5);
      message.Le64();
      EXPECT_EQ(message.Le16(), channel);
      message.Le32();
      EXPECT_EQ(message.Le64(), time);
      EXPECT_GE(time, chunk.start);
      EXPECT_LE(time, chunk.end);
      ++indexed[channel];
    }
  }

  std::vector<Walked> Of(std::uint8_t op) const {
    std::vector<Walked> found;
    for (const Walked& record : records)
      if (record.op == op) found.push_back(record);
    return found;
  }

  Bytes file;
  std::vector<Walked> records;
  std::vector<Chunk> chunks;
  std::map<std::uint16_t, std::uint64_t> indexed;
  std::uint16_t a_ = 0;
  std::uint16_t b_ = 0;
};

TEST_F(Layout, TheIndexesOfChunksNameEachMessageOnce) {
  EXPECT_EQ(chunks.size(), 3U);
  EXPECT_EQ(indexed[a_], 16U);
  EXPECT_EQ(indexed[b_], 9U);
  std::uint64_t messages = 0;
  for (const Chunk& chunk : chunks) {
    std::uint64_t first = UINT64_MAX;
    std::uint64_t last = 0;
    for (const Walked& record : Walk(chunk.messages, 0)) {
      if (record.op != 5) continue;
      ByteReader r(record.content.data + 6, 8);
      const std::uint64_t time = r.Le64();
      first = std::min(first, time);
      last = std::max(last, time);
      ++messages;
    }
    EXPECT_EQ(chunk.start, first);
    EXPECT_EQ(chunk.end, last);
  }
  EXPECT_EQ(messages, 25U);
}

TEST_F(Layout, TheSummaryTellsWhereTheChunksAre) {
  const auto summary = Of(8);
  ASSERT_EQ(summary.size(), chunks.size());
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    ByteReader r(summary[i].content);
    EXPECT_EQ(r.Le64(), chunks[i].start);
    EXPECT_EQ(r.Le64(), chunks[i].end);
    EXPECT_EQ(r.Le64(), chunks[i].record.offset);
    EXPECT_EQ(r.Le64(), chunks[i].record.size);
    EXPECT_EQ(Map(&r), chunks[i].index_offsets);
    EXPECT_EQ(r.Le64(), chunks[i].indexes_size);
    EXPECT_EQ(Text(&r), "");
    EXPECT_EQ(r.Le64(), chunks[i].messages.size);
    EXPECT_EQ(r.Le64(), chunks[i].messages.size);
    EXPECT_EQ(r.remaining(), 0U);
  }
}

TEST_F(Layout, TheStatisticsCountWhatIsThere) {
  ASSERT_EQ(Of(11).size(), 1U);
  ByteReader r(Of(11)[0].content);
  EXPECT_EQ(r.Le64(), 25U);
  EXPECT_EQ(r.Le16(), 2U);  // the number of schemas
  EXPECT_EQ(r.Le32(), 2U);  // the number of channels; the third channel has no messages
  EXPECT_EQ(r.Le32(), 0U);
  EXPECT_EQ(r.Le32(), 0U);
  EXPECT_EQ(r.Le32(), 3U);  // the number of chunks
  EXPECT_EQ(r.Le64(), kSecond / 2);
  EXPECT_EQ(r.Le64(), 29 * kSecond / 10);
  EXPECT_EQ(Map(&r), indexed);
  EXPECT_EQ(r.remaining(), 0U);
}

TEST_F(Layout, TheEndTellsWhereTheSummaryIsAndItsGroups) {
  const Walked& end = records.back();
  ASSERT_EQ(end.op, 2);
  EXPECT_EQ(Of(2).size(), 1U);
  ASSERT_EQ(Of(15).size(), 1U);
  const Walked data_end = Of(15)[0];
  ByteReader footer(end.content);
  const std::uint64_t summary = footer.Le64();
  EXPECT_EQ(summary, data_end.offset + data_end.size);
  EXPECT_EQ(footer.Le64(), Of(14)[0].offset);
  const std::uint64_t covered = end.offset + 9 + 16;
  EXPECT_EQ(footer.Le32(),
            Crc32({file.data() + summary, static_cast<std::size_t>(covered - summary)}));
  ByteReader data(data_end.content);
  EXPECT_EQ(data.Le32(), Crc32({file.data(), static_cast<std::size_t>(data_end.offset)}));
  for (const Walked& group : Of(14)) {
    ByteReader r(group.content);
    const std::uint8_t op = r.U8();
    const std::uint64_t start = r.Le64();
    const std::uint64_t size = r.Le64();
    for (const Walked& record : records) {
      const bool inside = record.offset >= start && record.offset < start + size;
      EXPECT_EQ(inside, record.op == op && record.offset >= summary) << int{op};
    }
  }
}

TEST_F(Layout, BeginsWithAHeaderAndNamesChannelsBeforeTheirMessages) {
  const std::array<std::uint8_t, 8> magic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
  EXPECT_TRUE(std::equal(magic.begin(), magic.end(), file.begin()));
  EXPECT_TRUE(std::equal(magic.begin(), magic.end(), file.end() - 8));
  ASSERT_EQ(records.front().op, 1);
  ByteReader r(records.front().content);
  EXPECT_EQ(Text(&r), "ros2");
  EXPECT_NE(Text(&r), "");
  EXPECT_EQ(r.remaining(), 0U);
  std::set<std::uint16_t> known;
  for (const Chunk& chunk : chunks) {
    for (const Walked& record : Walk(chunk.messages, 0)) {
      ByteReader first(record.content);
      const std::uint16_t id = first.Le16();
      if (record.op == 4) known.insert(id);
      if (record.op == 5) {
        EXPECT_EQ(known.count(id), 1U);
      }
    }
  }
}

TEST_F(Layout, IsReadAsItStands) {
  const auto statistics = ParseStatistics(Of(11)[0].content);
  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->messages, 25U);
  EXPECT_EQ(statistics->channels, 2U);
  EXPECT_EQ(statistics->chunks, 3U);
  EXPECT_EQ(statistics->start_time, kSecond / 2);
  EXPECT_EQ(statistics->end_time, 29 * kSecond / 10);
}

}  // namespace
}  // namespace lidar::mcap
