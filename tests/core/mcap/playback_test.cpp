// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests recordings that are read while they are being written.
#include "src/mcap/playback.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "tests/core/mcap/memory_file.h"
#include "tests/support/files.h"

namespace lidar::mcap {
namespace {

namespace fs = std::filesystem;
using test::FileMaker;
using test::kSecond;

/// An input that counts the calls of Read().
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

class Growing : public lidar::test::FolderTest {
 protected:
  /// Records messages one second apart. Each message has a chunk of its own.
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
  // The file ends within a chunk, because the writer has not finished it yet.
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

/// Returns `file` with a damaged byte in its first chunk.
Bytes Damaged(Bytes file) {
  const ChunkPlace chunk = test::Open(file)->index().chunks.front();
  file[static_cast<std::size_t>(chunk.offset + chunk.size - 5)] ^= 0x55;
  return file;
}

TEST_F(Growing, CountsTheDamageOfAllItsFilesAlsoBehindASeek) {
  Record(0, 3);
  for (const char* name : {"a1.mcap", "a2.mcap"}) Save(name, Damaged(maker_.file()));
  const auto playback = Playback::Open(folder_ + "/a%d.mcap", &cancelled_, &why_);
  ASSERT_NE(playback, nullptr) << why_;
  EXPECT_EQ(Count(playback.get()), 4U);
  EXPECT_EQ(playback->damaged_chunks(), 2U);
  playback->Seek(0);
  EXPECT_EQ(playback->damaged_chunks(), 2U);
  EXPECT_TRUE(playback->Next());
  playback->Seek(0);
  EXPECT_EQ(playback->damaged_chunks(), 3U) << "and of the file that was open";
}

TEST_F(Growing, PassesOverMessagesWithoutASchema) {
  Record(0, 2);
  const std::uint16_t bare = maker_.AddChannelWithoutSchema("notes");
  ASSERT_TRUE(maker_.Add(bare, Time(2), "{}"));
  Record(3, 5);
  ASSERT_TRUE(maker_.writer().Finish());
  Save("a.mcap", maker_.file());
  const auto playback = Playback::Open(folder_ + "/a.mcap", &cancelled_, &why_);
  ASSERT_NE(playback, nullptr) << why_;
  EXPECT_EQ(Count(playback.get()), 4U);
}

TEST_F(Growing, CountsFilesThatBreakOffAndThoseThatCannotBeRead) {
  Record(0, 2);
  Save("a1.mcap", maker_.file());
  Save("a2.mcap", Bytes(100, 'x'));
  ASSERT_TRUE(maker_.writer().Finish());
  Save("a3.mcap", maker_.file());
  Save("a4.mcap", Bytes(kMagic.begin(), kMagic.end()));
  const auto playback = Playback::Open(folder_ + "/a%d.mcap", &cancelled_, &why_);
  ASSERT_NE(playback, nullptr) << why_;
  for (int refreshes = 0; refreshes < 2; ++refreshes) {
    EXPECT_EQ(playback->unclosed_files(), 1U);
    EXPECT_EQ(playback->unreadable_files(), 2U);
    EXPECT_EQ(why_, "it holds no messages");
    ASSERT_TRUE(playback->Refresh(&why_));
  }
}

TEST_F(Growing, SaysWhyItsFolderCannotBeListed) {
  Save("a.mcap", maker_.file());
  EXPECT_EQ(Playback::Open(folder_ + "/a.mcap/r%d.mcap", &cancelled_, &why_), nullptr);
  EXPECT_EQ(why_, "Not a directory");
  EXPECT_EQ(Playback::Open(folder_ + "/none/r%d.mcap", &cancelled_, &why_), nullptr);
  EXPECT_EQ(why_, "there is no such file");
}

TEST_F(Growing, LastsFromItsEarliestToItsLatestFileWhateverTheirOrder) {
  Record(5, 8);
  Save("a1.mcap", maker_.file());
  FileMaker early{WriterSettings{}};
  const auto channel = early.AddChannel("points");
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(early.Add(channel, Time(i), "message"));
  ASSERT_TRUE(early.writer().Finish());
  Save("a2.mcap", early.file());
  const auto playback = Playback::Open(folder_ + "/a%d.mcap", &cancelled_, &why_);
  ASSERT_NE(playback, nullptr) << why_;
  EXPECT_EQ(playback->start_time(), Time(0));
  EXPECT_EQ(playback->end_time(), Time(7));
}

TEST_F(Growing, ASeekIntoAnyOfItsFilesBeginsWithTheMessageOfItsTime) {
  Record(0, 3);
  Save("a1.mcap", maker_.file());
  FileMaker next{WriterSettings{}};
  const auto channel = next.AddChannel("points");
  for (int i = 3; i < 6; ++i) ASSERT_TRUE(next.Add(channel, Time(i), "message"));
  ASSERT_TRUE(next.writer().Finish());
  Save("a2.mcap", next.file());
  const auto playback = Playback::Open(folder_ + "/a%d.mcap", &cancelled_, &why_);
  ASSERT_NE(playback, nullptr) << why_;
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(Count(playback.get(), Time(i)), static_cast<std::size_t>(6 - i));
    EXPECT_EQ(Count(playback.get(), Time(i) + 1), static_cast<std::size_t>(5 - i));
  }
}

TEST_F(Growing, IsReadAnewWhereAnotherFileOfItsSizeHasItsName) {
  for (const bool closed : {false, true}) {
    const std::string name = closed ? "closed.mcap" : "open.mcap";
    std::size_t size = 0;
    std::unique_ptr<Playback> playback;
    for (const int first : {0, 50}) {
      WriterSettings settings;
      settings.compression = Compression::kNone;
      FileMaker maker{settings};
      const auto channel = maker.AddChannel("points");
      for (int i = first; i < first + 3; ++i) {
        ASSERT_TRUE(maker.Add(channel, Time(i), "message"));
        ASSERT_TRUE(maker.writer().Flush());
      }
      if (closed) {
        ASSERT_TRUE(maker.writer().Finish());
      }
      if (first > 0) {
        ASSERT_EQ(maker.file().size(), size);
      }
      size = maker.file().size();
      Save(name, maker.file());
      fs::last_write_time(folder_ + "/" + name,
                          fs::file_time_type::clock::now() - std::chrono::seconds(100 - first));
      if (!playback) playback = Playback::Open(folder_ + "/" + name, &cancelled_, &why_);
      ASSERT_TRUE(playback && playback->Refresh(&why_)) << why_;
      EXPECT_EQ(playback->start_time(), Time(first));
      EXPECT_EQ(Count(playback.get(), Time(first + 1)), 2U);
    }
  }
}

}  // namespace
}  // namespace lidar::mcap
