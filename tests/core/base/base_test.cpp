// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/byte_writer.h"
#include "src/base/crc.h"
#include "src/base/row_file.h"
#include "src/base/sequence.h"
#include "src/base/units.h"

namespace lidar {
namespace {
using namespace std::chrono_literals;

ByteView View(const char* text) {
  return {reinterpret_cast<const std::uint8_t*>(text), std::strlen(text)};
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
  EXPECT_TRUE(IsNewer<std::uint16_t>(1, 65535));
  EXPECT_FALSE(IsNewer<std::uint16_t>(65535, 1));
}

TEST(Sequence, UnwrapsNextToTheNewestAndNotToTheLast) {
  SequenceUnwrapper<std::uint16_t> u;
  EXPECT_EQ(u.Unwrap(40000), 40000);
  EXPECT_EQ(u.Unwrap(10000), 10000);
  EXPECT_EQ(u.Unwrap(100), 65636);
}

TEST(Units, SizeOverTimeIsARate) {
  EXPECT_DOUBLE_EQ((DataSize::Bytes(1250) / 10ms).bits_per_second(), 1e6);
  EXPECT_EQ((DataRate::BitsPerSecond(1e6) * 10ms).bytes(), 1250);
  EXPECT_EQ(DataSize::Bytes(1250) / DataRate::BitsPerSecond(1e6), 10ms);
  EXPECT_EQ(DataSize::Bytes(1) / DataRate{}, Duration::max());
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

TEST(RowFile, SaysWhenTheDiskIsFull) {
  RowFile full("/dev/full");
  full.stream() << "row\n";
  EXPECT_FALSE(full.Flush());
  EXPECT_FALSE(full.ok());
  full.Close();
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));  // no regular file
}

}  // namespace
}  // namespace lidar
