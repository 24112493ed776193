// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <locale>
#include <string>
#include <vector>

#include "src/base/base64.h"
#include "src/base/byte_reader.h"
#include "src/base/byte_writer.h"
#include "src/base/crc.h"
#include "src/base/rate_meter.h"
#include "src/base/row_file.h"
#include "src/base/sequence.h"
#include "src/base/target_notifier.h"
#include "src/base/units.h"
#include "tests/support/german_numbers.h"

namespace lidar {
namespace {
using namespace std::chrono_literals;

ByteView View(const char* text) {
  return {reinterpret_cast<const std::uint8_t*>(text), std::strlen(text)};
}

TEST(RateMeter, AveragesOverItsWindow) {
  RateMeter meter(1s);
  constexpr Time kBegin{10s};
  EXPECT_EQ(meter.Rate(kBegin), DataRate());
  for (int i = 0; i < 30; ++i) meter.Add(kBegin + i * 100ms, DataSize::Bytes(1'250));
  EXPECT_NEAR(meter.Rate(kBegin + 2'900ms).bits_per_second(), 100e3, 1);
  EXPECT_NEAR(meter.Rate(kBegin + 3'400ms).bits_per_second(), 50e3, 1);
  EXPECT_EQ(meter.Rate(kBegin + 4s), DataRate());
  RateMeter first(1s);
  first.Add(kBegin, DataSize::Bytes(1'250));
  EXPECT_NEAR(first.Rate(kBegin).bits_per_second(), 1e6, 1) << "over ten milliseconds at least";
  meter.set_window(200ms);
  for (int i = 0; i < 5; ++i) meter.Add(kBegin + 5s + i * 100ms, DataSize::Bytes(1'250));
  EXPECT_NEAR(meter.Rate(kBegin + 5'450ms).bits_per_second(), 100e3, 1);
}

TEST(Crc, MatchesThePublishedCheckValues) {
  EXPECT_EQ(Crc32(View("123456789")), 0xCBF43926U);
  EXPECT_EQ(Crc64(View("123456789")), 0x995DC9BBDF1939FAU);
  EXPECT_EQ(Crc32(View("6789"), Crc32(View("12345"))), 0xCBF43926U);
}

TEST(ByteReader, ReadsWhatTheWriterWrote) {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  w.U8(1);
  w.Be16(0x0203);
  w.Be24(0x040506);
  w.Be32(0x0708090A);
  w.Be64(0x0B0C0D0E0F101112);
  w.Le16(0x1413);
  w.Le40(0x1918171615);
  w.LeF32(1.5F);
  w.LeF64(-2.25);
  ByteReader r(bytes.data(), bytes.size());
  EXPECT_EQ(r.U8(), 1);
  EXPECT_EQ(r.Be16(), 0x0203);
  EXPECT_EQ(r.Be24(), 0x040506U);
  EXPECT_EQ(r.Be32(), 0x0708090AU);
  EXPECT_EQ(r.Be64(), 0x0B0C0D0E0F101112U);
  EXPECT_EQ(r.Le16(), 0x1413);
  EXPECT_EQ(r.Le40(), 0x1918171615U);
  EXPECT_EQ(r.LeF32(), 1.5F);
  EXPECT_EQ(r.LeF64(), -2.25);
  EXPECT_TRUE(r.ok());
  EXPECT_EQ(r.remaining(), 0U);
}

TEST(ByteReader, HandsOutOnePartAfterTheOther) {
  const std::vector<std::uint8_t> bytes = {1, 2, 3, 4, 5, 6};
  ByteReader r(bytes.data(), bytes.size());
  r.Skip(1);
  EXPECT_EQ(r.Bytes(2).data[0], 2);
  EXPECT_EQ(r.position(), 3U);
  EXPECT_EQ(r.remaining(), 3U);
  EXPECT_EQ(r.Le24(), 0x060504U);
  EXPECT_TRUE(r.Rest().empty());
  EXPECT_TRUE(r.ok());
  EXPECT_EQ(r.Bytes(1).size, 0U);
  EXPECT_FALSE(r.ok());
}

TEST(ByteReader, StaysBrokenAfterAReadPastTheEnd) {
  const std::uint8_t bytes[] = {1, 2, 3};
  ByteReader r(bytes, sizeof bytes);
  EXPECT_EQ(r.Be32(), 0U);
  EXPECT_FALSE(r.ok());
  EXPECT_EQ(r.U8(), 0);
  EXPECT_TRUE(r.Bytes(1).empty());
}

TEST(Sequence, UnwrapsForwardsAndBackwardsOverTheWrap) {
  SequenceUnwrapper<std::uint16_t> u;
  EXPECT_EQ(u.Unwrap(65534), 65534);
  EXPECT_EQ(u.Unwrap(1), 65537);
  EXPECT_EQ(u.Unwrap(65535), 65535);
  EXPECT_EQ(u.Unwrap(2), 65538);
}

TEST(Sequence, UnwrapsNextToTheNewestAndNotToTheLast) {
  SequenceUnwrapper<std::uint16_t> u;
  EXPECT_EQ(u.Unwrap(40000), 40000);
  EXPECT_EQ(u.Unwrap(10000), 10000);
  EXPECT_EQ(u.Unwrap(100), 65636);
}

TEST(Sequence, FollowsTheNewestOverManyWraps) {
  SequenceUnwrapper<std::uint16_t> u;
  for (std::int64_t n = 0; n < 300'000; n += 30'000) {
    EXPECT_EQ(u.Unwrap(static_cast<std::uint16_t>(n)), n);
    EXPECT_EQ(u.newest(), n);
  }
}

TEST(Sequence, ANewerNumberIsAPositiveDistanceAway) {
  EXPECT_EQ(SequenceDistance<std::uint16_t>(7, 7), 0);
  EXPECT_EQ(SequenceDistance<std::uint16_t>(0, 65535), 1);
  EXPECT_EQ(SequenceDistance<std::uint32_t>(0, 1), -1);
}

TEST(Sequence, PeekingRemembersNothing) {
  SequenceUnwrapper<std::uint16_t> u;
  EXPECT_EQ(u.Peek(9), 9);
  EXPECT_FALSE(u.newest());
  u.Unwrap(65535);
  EXPECT_EQ(u.Peek(30000), 95536);
  EXPECT_EQ(u.newest(), 65535);
  u.Reset();
  EXPECT_EQ(u.Unwrap(3), 3);
}

TEST(Time, IsRoundedToTheNearestNanosecond) {
  EXPECT_EQ(FromSeconds(1.4e-9).count(), 1);
  EXPECT_EQ(FromSeconds(1.6e-9).count(), 2);
  EXPECT_EQ(FromSeconds(-1.6e-9).count(), -2);
  EXPECT_EQ(FromSeconds(0).count(), 0);
  EXPECT_EQ(Seconds(1500ms), 1.5);
  EXPECT_EQ(Milliseconds(1500us), 1.5);
}

TEST(Units, AreOrderedByTheirAmounts) {
  const DataSize one = DataSize::Bytes(1);
  const DataSize two = DataSize::Bytes(2);
  EXPECT_TRUE(one == DataSize::Bytes(1) && one != two && one < two && two > one);
  EXPECT_TRUE(one <= one && one >= one && one <= two && two >= one);
  EXPECT_FALSE(one == two || one != one || one < one || one > one || two <= one || one >= two);
  const DataRate slow = DataRate::BitsPerSecond(1);
  const DataRate fast = DataRate::BitsPerSecond(2);
  EXPECT_TRUE(slow == DataRate::BitsPerSecond(1) && slow != fast && slow < fast && fast > slow);
  EXPECT_TRUE(slow <= slow && slow >= slow && slow <= fast && fast >= slow);
  EXPECT_FALSE(slow == fast || fast == slow || slow != slow || slow < slow || slow > slow ||
               fast <= slow || slow >= fast);
}

TEST(Units, AreAddedAndTakenAway) {
  DataSize size = DataSize::Bytes(5);
  size += DataSize::Bytes(3);
  EXPECT_EQ(size.bytes(), 8);
  size -= DataSize::Bytes(2);
  EXPECT_EQ(size.bytes(), 6);
  EXPECT_EQ((size + DataSize::Bytes(4)).bytes(), 10);
  EXPECT_EQ((size - DataSize::Bytes(7)).bytes(), -1);
  EXPECT_EQ((size * 0.5).bytes(), 3);
  EXPECT_EQ(size / DataSize::Bytes(4), 1.5);
  EXPECT_EQ(size.bits(), 48);
  const DataRate rate = DataRate::BitsPerSecond(6);
  EXPECT_EQ((rate + rate).bits_per_second(), 12);
  EXPECT_EQ((rate - rate * 0.5).bits_per_second(), 3);
  EXPECT_EQ((rate / 3).bits_per_second(), 2);
  EXPECT_EQ(rate / DataRate::BitsPerSecond(4), 1.5);
}

TEST(Units, SizeOverTimeIsARate) {
  EXPECT_DOUBLE_EQ((DataSize::Bytes(1250) / 10ms).bits_per_second(), 1e6);
  EXPECT_EQ((DataRate::BitsPerSecond(1e6) * 10ms).bytes(), 1250);
  EXPECT_EQ(DataSize::Bytes(1250) / DataRate::BitsPerSecond(1e6), 10ms);
  EXPECT_EQ(DataSize::Bytes(1) / DataRate{}, Duration::max());
}

TEST(TargetNotifier, TellsMovesOfTwoPercentAtOnceAndAllElseEvery200Milliseconds) {
  const auto mbps = [](double rate) { return DataRate::BitsPerSecond(rate * 1e6); };
  const Time start{1h};
  TargetNotifier notifier;
  EXPECT_TRUE(notifier.ShouldNotify(start, mbps(10)));
  EXPECT_FALSE(notifier.ShouldNotify(start + 1ms, mbps(10.19)));
  EXPECT_TRUE(notifier.ShouldNotify(start + 1ms, mbps(10.21)));
  EXPECT_FALSE(notifier.ShouldNotify(start + 200ms, mbps(10.21)));
  EXPECT_TRUE(notifier.ShouldNotify(start + 201ms, mbps(10.21)));
  EXPECT_FALSE(notifier.ShouldNotify(start + 202ms, mbps(10.01)));
  EXPECT_TRUE(notifier.ShouldNotify(start + 202ms, mbps(9.99)));
  notifier.Reset();
  EXPECT_TRUE(notifier.ShouldNotify(start + 203ms, mbps(9.99)));
}

TEST(RowFile, KeepsItsRowsAndNothingThatIsEmpty) {
  const std::string path = ::testing::TempDir() + "row_file.txt";
  const auto exists = [&] { return std::filesystem::exists(path); };
  {
    RowFile empty(path);
    EXPECT_TRUE(empty.ok());
    EXPECT_TRUE(exists());
  }
  EXPECT_FALSE(exists());
  RowFile rows(path);
  rows.stream() << 1'234.5 << '\n';
  EXPECT_TRUE(rows.Flush());
  rows = RowFile();
  EXPECT_FALSE(rows.ok());
  std::string line;
  std::getline(std::ifstream(path) >> std::ws, line);
  EXPECT_EQ(line, "1234.5");
  std::filesystem::remove(path);
  EXPECT_FALSE(RowFile("/nonexistent/file").ok());
}

TEST(RowFile, KeepsRowsThatAreWrittenAsItCloses) {
  const std::string path = ::testing::TempDir() + "row_file_closed.txt";
  { RowFile(path).stream() << "row\n"; }
  ASSERT_TRUE(std::filesystem::exists(path));
  EXPECT_EQ(std::filesystem::file_size(path), 4U);
  std::filesystem::remove(path);
}

TEST(RowFile, HasTheNumbersOfTheCLocaleWhateverTheProgramSets) {
  const std::string path = ::testing::TempDir() + "row_file_locale.txt";
  const std::locale before = std::locale::global({std::locale(), new test::GermanNumbers});
  { RowFile(path).stream() << 0.5 << '\n'; }
  std::locale::global(before);
  std::string line;
  std::getline(std::ifstream(path) >> std::ws, line);
  EXPECT_EQ(line, "0.5");
  std::filesystem::remove(path);
}

TEST(RowFile, MovesWithItsFile) {
  const std::string path = ::testing::TempDir() + "row_file_moved.txt";
  const std::string other = ::testing::TempDir() + "row_file_other.txt";
  RowFile to(other);
  {
    RowFile from(path);
    from.stream() << "row\n";
    to = std::move(from);
  }
  // The move closed the empty file, which removed it.
  EXPECT_FALSE(std::filesystem::exists(other));
  EXPECT_TRUE(to.ok());
  EXPECT_TRUE(to.Flush());
  EXPECT_EQ(std::filesystem::file_size(path), 4U);
  RowFile last(std::move(to));
  EXPECT_TRUE(last.ok());
  last = RowFile(other);
  EXPECT_TRUE(std::filesystem::exists(other));
  last.Close();
  EXPECT_FALSE(std::filesystem::exists(other));  // Close() removed the empty file.
  EXPECT_TRUE(std::filesystem::exists(path));
  std::filesystem::remove(path);
}

TEST(RowFile, SaysWhenTheDiskIsFull) {
  RowFile full("/dev/full");
  full.stream() << "row\n";
  EXPECT_FALSE(full.Flush());
  EXPECT_FALSE(full.ok());
  full.Close();
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));  // /dev/full is no regular file, so it stays.
}

TEST(Base64, PadsAsTheStandardSaysAndReadsLines) {
  for (const auto& [bytes, text] : std::vector<std::pair<std::string, std::string>>{
           {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foobar", "Zm9vYmFy"}}) {
    const std::vector<std::uint8_t> plain(bytes.begin(), bytes.end());
    EXPECT_EQ(Base64(plain), text);
    EXPECT_EQ(FromBase64(text), plain);
    EXPECT_EQ(FromBase64("\n" + text + "\n"), plain);
  }
}

}  // namespace
}  // namespace lidar
