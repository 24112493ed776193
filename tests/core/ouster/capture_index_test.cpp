// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the offsets and the duration of captures that are longer than the captures in tests/data.
#include "src/ouster/capture_index.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "src/ouster/pcap_writer.h"

namespace lidar::ouster {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time kStart{seconds(1'700'000'000)};
constexpr int kDatagrams = 5000;

bool Always() { return true; }

/// A capture with one datagram per millisecond, whose payload is its number. The datagram with the
/// number `swapped` comes after the next one.
class CaptureIndexTest : public ::testing::Test {
 protected:
  void Write(int swapped = kDatagrams) {
    std::string error;
    const auto writer = PcapWriter::Open(path_, &error);
    ASSERT_TRUE(writer) << error;
    for (int i = 0; i < kDatagrams; ++i) {
      const int n = i == swapped ? i + 1 : i == swapped + 1 ? i - 1 : i;
      const auto bytes = static_cast<std::uint8_t>(n);
      const std::vector<std::uint8_t> payload(40, bytes);
      ASSERT_TRUE(writer->Write(kStart + milliseconds(n), 7502, {payload.data(), payload.size()}));
    }
    ASSERT_TRUE(writer->Close());
  }
  ~CaptureIndexTest() override { std::remove(path_.c_str()); }

  std::unique_ptr<PcapReader> OpenFile() const {
    std::string error;
    auto reader = PcapReader::Open(path_, &error);
    EXPECT_TRUE(reader) << error;
    return reader;
  }

  const std::string path_ = ::testing::TempDir() + "capture_index.pcap";
};

TEST_F(CaptureIndexTest, KnowsTheDurationOnceItReadAll) {
  Write();
  CaptureIndex index(OpenFile());
  EXPECT_FALSE(index.first());
  EXPECT_TRUE(index.ReadUntil(Duration::max(), Always));
  EXPECT_EQ(index.first(), kStart);
  EXPECT_EQ(index.duration(), milliseconds(kDatagrams - 1));
}

TEST_F(CaptureIndexTest, EndsWithItsLatestDatagramAlsoIfThatIsNotTheLast) {
  Write(kDatagrams - 2);
  CaptureIndex index(OpenFile());
  EXPECT_TRUE(index.ReadUntil(Duration::max(), Always));
  EXPECT_EQ(index.duration(), milliseconds(kDatagrams - 1));
}

TEST_F(CaptureIndexTest, BeginsWithTheFirstDatagramOfTheFileAlsoIfTheNextIsEarlier) {
  Write(0);
  CaptureIndex index(OpenFile());
  EXPECT_TRUE(index.ReadUntil(milliseconds(0), Always));
  EXPECT_EQ(index.first(), kStart + milliseconds(1));
  EXPECT_TRUE(index.ReadUntil(milliseconds(1), Always));
  EXPECT_EQ(index.duration(), milliseconds(1));
}

TEST_F(CaptureIndexTest, ReadsNoFurtherThanItWasAsked) {
  Write();
  CaptureIndex index(OpenFile());
  EXPECT_TRUE(index.ReadUntil(seconds(2), Always));
  EXPECT_EQ(index.duration(), seconds(2));
  EXPECT_TRUE(index.ReadUntil(seconds(1), Always));
  EXPECT_EQ(index.duration(), seconds(2));
  EXPECT_FALSE(index.ReadUntil(seconds(4), [] { return false; }));
}

TEST_F(CaptureIndexTest, AReaderSeesAllThatIsLaterFromItsPlaces) {
  Write(3000);
  CaptureIndex index(OpenFile());
  ASSERT_TRUE(index.ReadUntil(Duration::max(), Always));
  EXPECT_FALSE(index.OffsetBefore(Duration{0}));
  for (const int time : {150, 999, 2999, 3001, 3102, 4998, 60'000}) {
    const auto offset = index.OffsetBefore(milliseconds(time));
    ASSERT_TRUE(offset) << time;
    const auto reader = OpenFile();
    ASSERT_TRUE(reader->GoTo(*offset));
    const auto next = reader->Next();
    ASSERT_TRUE(next) << time;
    EXPECT_LE(next->time, kStart + milliseconds(time));
    // The offset must not be much earlier than the time, because this would make a seek slow.
    EXPECT_GE(next->time, kStart + milliseconds(std::min(time, kDatagrams) - 250));
  }
}

TEST_F(CaptureIndexTest, EndsWhereTheFileIsDamaged) {
  Write();
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) / 2);
  CaptureIndex index(OpenFile());
  EXPECT_TRUE(index.ReadUntil(Duration::max(), Always));
  EXPECT_NEAR(static_cast<double>(index.duration().count()), 2.5e9, 1e7);
}

class PcapWriterTest : public CaptureIndexTest {
 protected:
  std::unique_ptr<PcapWriter> Open() const {
    std::string error;
    auto writer = PcapWriter::Open(path_, &error);
    EXPECT_TRUE(writer) << error;
    return writer;
  }
};

TEST_F(PcapWriterTest, TellsWhyAFileCannotBeWritten) {
  std::string error;
  EXPECT_FALSE(PcapWriter::Open("/no/such/folder/a.pcap", &error));
  EXPECT_NE(error.find("No such file or directory"), std::string::npos) << error;
}

TEST_F(PcapWriterTest, WritesPayloadsAsLargeAsUdpCarriesAndNoLarger) {
  const auto writer = Open();
  const std::vector<std::uint8_t> payload(65'508, 7);
  EXPECT_TRUE(writer->Write(kStart, 7502, {payload.data(), 65'507}));
  EXPECT_FALSE(writer->Write(kStart, 7502, {payload.data(), 65'508}));
  EXPECT_TRUE(writer->Close());
  EXPECT_TRUE(writer->Close()) << "again";
  const auto reader = OpenFile();
  const auto only = reader->Next();
  ASSERT_TRUE(only);
  EXPECT_EQ(only->datagram.payload.size(), 65'507U);
  EXPECT_FALSE(reader->Next());
  EXPECT_EQ(reader->error(), "");
}

/// When the limit is reached, the end of the file is still in a buffer, so that only Close() can
/// fail.
TEST_F(PcapWriterTest, LeavesNoFileThatIsCutShort) {
  auto* const before = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  rlimit small = limit;
  small.rlim_cur = 100;
  const auto writer = Open();
  const std::vector<std::uint8_t> payload(1'000, 7);
  EXPECT_TRUE(writer->Write(kStart, 7502, {payload.data(), payload.size()}));
  setrlimit(RLIMIT_FSIZE, &small);
  const bool whole = writer->Close();
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, before);
  EXPECT_FALSE(whole);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace lidar::ouster
