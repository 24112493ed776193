// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the bytes of the reports of RFC 8888.
#include "src/rtcp/ccfb.h"

#include <gtest/gtest.h>

#include "src/rtcp/report_clock.h"
#include "tests/core/rtcp/bytes.h"

namespace lidar::rtcp {
namespace {

using namespace std::chrono_literals;

/// Returns a report on `count` packets of one SSRC, beginning with number 100. All packets are
/// received, except for the last one if `last_received` is false.
CongestionFeedback Report(std::size_t count, bool last_received = true) {
  CongestionFeedback f;
  f.sender_ssrc = 7;
  f.report_timestamp = 0x01020304;
  f.blocks.push_back({0xAABBCCDD, 100, {}});
  for (std::size_t i = 0; i < count; ++i)
    f.blocks[0].metrics.push_back({i + 1 < count || last_received, Ecn::kEct1, 0ms});
  return f;
}

TEST(Ccfb, BytesAreThoseOfRfc8888) {
  CongestionFeedback f = Report(0);
  f.blocks[0].metrics = {{true, Ecn::kCe, 125ms}, {}, {true, Ecn::kEct0, std::nullopt}};
  const Bytes expected = {0x8B, 205, 0,    6,   0, 0, 0,    7,    0xAA, 0xBB, 0xCC, 0xDD, 0, 100,
                          0,    3,   0xE0, 128, 0, 0, 0xDF, 0xFF, 0,    0,    1,    2,    3, 4};
  EXPECT_EQ(BuildCcfb(f), expected);
}

TEST(Ccfb, OffsetsSaturateAndSayWhenTheyAreMissing) {
  CongestionFeedback f = Report(0);
  f.blocks[0].metrics = {{true, Ecn::kEct1, 7996ms}, {true, Ecn::kEct1, 10s}};
  const auto parsed = CcfbParser().Parse(View(BuildCcfb(f)));
  ASSERT_TRUE(parsed);
  ASSERT_TRUE(parsed->blocks[0].metrics[0].arrival_offset);
  EXPECT_NEAR(Milliseconds(*parsed->blocks[0].metrics[0].arrival_offset), 7996, 0.5);
  EXPECT_FALSE(parsed->blocks[0].metrics[1].arrival_offset);
}

struct Reading {
  NumReports reading;
  std::size_t count;
};
class CcfbReading : public ::testing::TestWithParam<Reading> {};

TEST_P(CcfbReading, IsDetectedFromOnePacket) {
  const auto [reading, count] = GetParam();
  CcfbParser parser;
  const auto parsed = parser.Parse(View(BuildCcfb(Report(count), reading)));
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->sender_ssrc, 7U);
  EXPECT_EQ(parsed->report_timestamp, 0x01020304U);
  ASSERT_EQ(parsed->blocks.size(), 1U);
  EXPECT_EQ(parsed->blocks[0].begin_seq, 100);
  EXPECT_EQ(parsed->blocks[0].metrics.size(), count);
  EXPECT_EQ(parser.num_reports(), reading);
}
INSTANTIATE_TEST_SUITE_P(Counts, CcfbReading,
                         ::testing::Values(Reading{NumReports::kCount, 1},
                                           Reading{NumReports::kCount, 2},
                                           Reading{NumReports::kCount, 31},
                                           Reading{NumReports::kCount, 64},
                                           Reading{NumReports::kCountMinusOne, 1},
                                           Reading{NumReports::kCountMinusOne, 2},
                                           Reading{NumReports::kCountMinusOne, 31},
                                           Reading{NumReports::kCountMinusOne, 64}));

TEST(Ccfb, AnAmbiguousPacketIsReadAsThePeersEarlierOnes) {
  CcfbParser parser;
  const Bytes ambiguous = BuildCcfb(Report(4, false), NumReports::kCountMinusOne);
  EXPECT_EQ(parser.Parse(View(ambiguous))->blocks[0].metrics.size(), 3U);
  parser.Parse(View(BuildCcfb(Report(4), NumReports::kCountMinusOne)));
  EXPECT_EQ(parser.Parse(View(ambiguous))->blocks[0].metrics.size(), 4U);
  // This report is from another peer, or from a new version of the same peer.
  parser.Parse(View(BuildCcfb(Report(4))));
  EXPECT_EQ(parser.Parse(View(ambiguous))->blocks[0].metrics.size(), 3U);
}

TEST(Ccfb, SeveralSourcesShareAPacket) {
  CongestionFeedback f = Report(3);
  f.blocks.push_back({42, 65535, {{true, Ecn::kCe, 1ms}, {}}});
  const auto parsed = CcfbParser().Parse(View(BuildCcfb(f)));
  ASSERT_TRUE(parsed);
  ASSERT_EQ(parsed->blocks.size(), 2U);
  EXPECT_EQ(parsed->blocks[1].ssrc, 42U);
  EXPECT_EQ(parsed->blocks[1].begin_seq, 65535);
  EXPECT_EQ(parsed->blocks[1].metrics[0].ecn, Ecn::kCe);
  EXPECT_FALSE(parsed->blocks[1].metrics[1].received);
}

TEST(Ccfb, ASourceWithoutPacketsIsLeftOut) {
  CongestionFeedback f = Report(3);
  const Bytes without = BuildCcfb(f);
  f.blocks.push_back({42, 7, {}});
  EXPECT_EQ(BuildCcfb(f), without);
}

TEST(Ccfb, EveryTruncationAndEveryWrongHeaderIsRefused) {
  const Bytes good = BuildCcfb(Report(6));
  for (std::size_t n = 0; n < good.size(); ++n) {
    Bytes cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_FALSE(CcfbParser().Parse(View(cut))) << n;
    if (n < 4 || n % 4 != 0) continue;
    // The length agrees with the truncated packet.
    cut[3] = static_cast<std::uint8_t>(n / 4 - 1);
    EXPECT_FALSE(CcfbParser().Parse(View(cut)) && n != 12) << n;
  }
  for (const std::size_t byte : {0U, 1U, 3U}) {
    Bytes bad = good;
    bad[byte] ^= 1;
    EXPECT_FALSE(CcfbParser().Parse(View(bad))) << byte;
  }
}

TEST(Ccfb, ACompoundIsSplitAndForeignPacketsAreLeftAlone) {
  const Bytes receiver_report = {0x80, 201, 0, 1, 0, 0, 0, 9};
  Bytes compound = receiver_report;
  const Bytes ccfb = BuildCcfb(Report(2));
  compound.insert(compound.end(), ccfb.begin(), ccfb.end());
  const auto packets = SplitRtcp(View(compound));
  ASSERT_EQ(packets.size(), 2U);
  EXPECT_FALSE(IsCcfb(packets[0]));
  EXPECT_TRUE(IsCcfb(packets[1]));
  EXPECT_TRUE(CcfbParser().Parse(packets[1]));
  compound.pop_back();
  EXPECT_TRUE(SplitRtcp(View(compound)).empty());
}

/// Returns `report` with `added` bytes of padding. The last byte of the padding says that it has
/// `said` bytes.
Bytes Padded(Bytes report, std::size_t added, std::uint8_t said, std::uint8_t fill = 0x5A) {
  report[0] |= 0x20;
  report[3] = static_cast<std::uint8_t>(report[3] + added / 4);
  report.insert(report.end(), added, fill);  // RFC 3550 does not specify the contents.
  report.back() = said;
  return report;
}

TEST(Ccfb, ReadsAPaddedReportAsTheSameReport) {
  for (const std::size_t count : {1U, 2U, 3U, 16U}) {
    const Bytes plain = BuildCcfb(Report(count));
    for (const std::size_t padding : {4U, 8U, 12U, 128U}) {
      const auto parsed =
          CcfbParser().Parse(View(Padded(plain, padding, static_cast<std::uint8_t>(padding))));
      ASSERT_TRUE(parsed) << count << " metrics, " << padding << " bytes of padding";
      EXPECT_EQ(BuildCcfb(*parsed), plain) << padding;
    }
  }
}

TEST(Ccfb, RefusesPaddingThatLeavesNoReport) {
  const Bytes plain = BuildCcfb(Report(2));  // It has 28 bytes, 20 of which belong to no block.
  for (const int said : {0, 1, 2, 3, 5, 36, 200})
    for (const int fill : {0x5A, 0})  // zeros could be a block of no packets
      EXPECT_FALSE(CcfbParser().Parse(
          View(Padded(plain, 8, static_cast<std::uint8_t>(said), static_cast<std::uint8_t>(fill)))))
          << said << " " << fill;
}

TEST(ReportClock, GoesOnWhereTimestampsWrapAfterEighteenHours) {
  ReportClock clock;
  const Time before{65535s + 900ms};
  const Time first = clock.Unwrap(ReportClock::ToTimestamp(before));
  const Time second = clock.Unwrap(ReportClock::ToTimestamp(before + 200ms));
  EXPECT_NEAR(Milliseconds(second - first), 200, 0.02);
  const Time older = clock.Unwrap(ReportClock::ToTimestamp(before + 50ms));
  EXPECT_NEAR(Milliseconds(older - first), 50, 0.02) << "a report that was overtaken";
}

}  // namespace
}  // namespace lidar::rtcp
