// SPDX-License-Identifier: LGPL-2.1-or-later
// Recordings that are read while they are written.
#include "src/mcap/playback.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "tests/core/mcap/memory_file.h"

namespace lidar::mcap {
namespace {

namespace fs = std::filesystem;
using test::FileMaker;
using test::kSecond;

/// Counts what is read.
class CountedInput : public test::MemoryInput {
 public:
  CountedInput(Bytes bytes, std::size_t* reads) : MemoryInput(std::move(bytes)), reads_(reads) {}
  bool Read(std::uint64_t offset, std::size_t n, std::uint8_t* to) override {
    ++*reads_;
    return MemoryInput::Read(offset, n, to);
  }

 private:
  std::size_t* const reads_;
};

class Growing : public ::testing::Test {
 protected:
  Growing() : folder_(::testing::TempDir() + "playback-" + std::to_string(getpid())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Growing() override { fs::remove_all(folder_); }

  /// A message a second, each a chunk.
  void Record(int from, int to) {
    for (int i = from; i < to; ++i) {
      ASSERT_TRUE(maker_.Add(channel_, Time(i), "message"));
      ASSERT_TRUE(maker_.writer().Flush());
    }
  }
  static std::uint64_t Time(int i) { return static_cast<std::uint64_t>(i + 1) * kSecond; }
  void Save(const std::string& name, const Bytes& bytes) const {
    std::ofstream file(folder_ + "/" + name, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  static std::size_t Count(Playback* playback, std::uint64_t from = 0) {
    playback->Seek(from);
    std::size_t n = 0;
    while (playback->Next()) ++n;
    return n;
  }

  const std::string folder_;
  FileMaker maker_{WriterSettings{}};
  const std::uint16_t channel_ = maker_.AddChannel("points");
  const std::atomic<bool> cancelled_{false};
  std::string why_;
};

TEST_F(Growing, ShowsWhatHasComeAfterARefresh) {
  Record(0, 3);
  Save("a.mcap", maker_.file());
  const auto playback = Playback::Open(folder_ + "/a.mcap", &cancelled_, &why_);
  ASSERT_NE(playback, nullptr) << why_;
  EXPECT_EQ(Count(playback.get()), 3U);
  Record(3, 5);
  // The writer is in the middle of a chunk.
  Bytes part = maker_.file();
  part.resize(maker_.ends()[3] + 30);
  Save("a.mcap", part);
  ASSERT_TRUE(playback->Refresh(&why_));
  EXPECT_EQ(playback->end_time(), Time(3));
  EXPECT_EQ(Count(playback.get(), Time(2)), 2U);
  ASSERT_TRUE(maker_.writer().Finish());
  Save("a.mcap", maker_.file());
  ASSERT_TRUE(playback->Refresh(&why_));
  EXPECT_EQ(playback->unclosed_files(), 0U);
  EXPECT_EQ(Count(playback.get()), 5U);
}

TEST_F(Growing, GoesOnWithTheNextFileAndWithoutTheOldest) {
  Record(0, 3);
  Save("a1.mcap", maker_.file());
  const auto playback = Playback::Open(folder_ + "/a%d.mcap", &cancelled_, &why_);
  ASSERT_NE(playback, nullptr) << why_;
  FileMaker next{WriterSettings{}};
  ASSERT_TRUE(next.Add(next.AddChannel("points"), Time(3), "message"));
  ASSERT_TRUE(next.writer().Flush());
  Save("a2.mcap", next.file());
  ASSERT_TRUE(playback->Refresh(&why_));
  EXPECT_EQ(Count(playback.get()), 4U);
  fs::remove(folder_ + "/a1.mcap");
  ASSERT_TRUE(playback->Refresh(&why_));
  EXPECT_EQ(playback->start_time(), Time(3));
  EXPECT_EQ(Count(playback.get()), 1U);
  fs::remove(folder_ + "/a2.mcap");
  EXPECT_FALSE(playback->Refresh(&why_));
  EXPECT_EQ(why_, "there is no such file");
  EXPECT_EQ(Count(playback.get()), 0U);
}

TEST_F(Growing, IsScannedOnlyWhereItHasGrown) {
  Record(0, 200);
  std::size_t all = 0;
  const auto first = Reader::Open(std::make_unique<CountedInput>(maker_.file(), &all), &why_);
  ASSERT_EQ(first->index().chunks.size(), 200U);
  Record(200, 201);
  std::size_t rest = 0;
  const auto second =
      Reader::Open(std::make_unique<CountedInput>(maker_.file(), &rest), &why_, first->index());
  EXPECT_EQ(second->index().chunks.size(), 201U);
  EXPECT_LT(rest, all / 10);
}

TEST_F(Growing, IsScannedAnewWhereAnotherFileHasItsName) {
  Record(0, 20);
  const auto first = test::Open(maker_.file());
  FileMaker other{WriterSettings{}};
  const auto channel = other.AddChannel("others");
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(other.Add(channel, Time(100 + i), "of another size"));
    ASSERT_TRUE(other.writer().Flush());
  }
  const auto second =
      Reader::Open(std::make_unique<test::MemoryInput>(other.file()), &why_, first->index());
  EXPECT_EQ(second->index().chunks.size(), 30U);
  EXPECT_EQ(second->index().start_time(), Time(100));
  EXPECT_EQ(test::ReadAll(second.get()).size(), 30U);
}

}  // namespace
}  // namespace lidar::mcap
