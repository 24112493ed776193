// SPDX-License-Identifier: LGPL-2.1-or-later
// Transport-wide feedback on the wire, and back to packets.
#include "src/scream/feedback/twcc.h"

#include <gtest/gtest.h>

#include "src/scream/feedback/twcc_mapper.h"

namespace lidar::scream {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

ByteView View(const Bytes& b) { return {b.data(), b.size()}; }

TwccFeedback Report(std::vector<std::optional<Duration>> arrivals) {
  TwccFeedback f;
  f.sender_ssrc = 7;
  f.media_ssrc = 8;
  f.base_number = 65534;
  f.report_number = 3;
  f.arrivals = std::move(arrivals);
  return f;
}

TEST(Twcc, ReadsWhatTheDraftDescribes) {
  // One chunk of two-bit symbols: small, not received, large; their deltas; padding.
  const Bytes bytes = {0x8F, 205, 0, 6, 0, 0, 0,    7, 0, 0,    0,    8, 0, 5,
                       0,    3,   0, 0, 2, 9, 0xD2, 0, 4, 0xFF, 0xFC, 0, 0, 0};
  const auto full = ParseTwcc(View(bytes));
  ASSERT_TRUE(full);
  EXPECT_EQ(full->sender_ssrc, 7U);
  EXPECT_EQ(full->media_ssrc, 8U);
  EXPECT_EQ(full->base_number, 5);
  EXPECT_EQ(full->report_number, 9);
  ASSERT_EQ(full->arrivals.size(), 3U);
  EXPECT_EQ(full->arrivals[0], Duration{129ms});
  EXPECT_FALSE(full->arrivals[1]);
  EXPECT_EQ(full->arrivals[2], Duration{128ms}) << "four ticks back";
}

class TwccRoundTrip : public ::testing::TestWithParam<std::vector<std::optional<Duration>>> {};

TEST_P(TwccRoundTrip, GivesTheSameArrivals) {
  const TwccFeedback f = Report(GetParam());
  const auto bytes = BuildTwcc(f);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(bytes->size() % 4, 0U);
  EXPECT_TRUE(IsTwcc(View(*bytes)));
  EXPECT_FALSE(IsCcfb(View(*bytes)));
  const auto parsed = ParseTwcc(View(*bytes));
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->arrivals, f.arrivals);
  EXPECT_EQ(parsed->base_number, 65534);
  EXPECT_EQ(parsed->report_number, 3);
}

std::vector<std::optional<Duration>> Many(int n) {
  std::vector<std::optional<Duration>> arrivals;
  for (int i = 0; i < n; ++i)
    arrivals.push_back(i % 5 == 3 ? std::nullopt : std::optional<Duration>(1s + i * 250us));
  return arrivals;
}
INSTANTIATE_TEST_SUITE_P(Shapes, TwccRoundTrip,
                         ::testing::Values(std::vector<std::optional<Duration>>{100ms},
                                           std::vector<std::optional<Duration>>{100ms, 100ms, 90ms,
                                                                                std::nullopt, 5s},
                                           std::vector<std::optional<Duration>>{std::nullopt, 1h},
                                           std::vector<std::optional<Duration>>(20, std::nullopt),
                                           std::vector<std::optional<Duration>>(9000, Duration{3s}),
                                           Many(13), Many(1000)));

TEST(Twcc, BuildsNothingThatTheFormatCannotHold) {
  EXPECT_FALSE(BuildTwcc(Report({})));
  EXPECT_FALSE(BuildTwcc(Report({0s, 9s})));
  EXPECT_FALSE(BuildTwcc(Report(std::vector<std::optional<Duration>>(kMaxTwccPackets + 1))));
}

TEST(Twcc, RefusesEveryCutAndEveryClaimOfMore) {
  const Bytes whole = *BuildTwcc(Report(Many(40)));
  for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_FALSE(ParseTwcc({whole.data(), n})) << n;
  Bytes more = whole;
  more[15] = 200;  // packets that no chunk describes
  EXPECT_FALSE(ParseTwcc(View(more)));
  more = whole;
  more[14] = 0xFF;
  EXPECT_FALSE(ParseTwcc(View(more))) << "more than can be told apart";
  more = whole;
  more[15] = 0;
  EXPECT_FALSE(ParseTwcc(View(more))) << "no packet at all";
}

TEST(Twcc, RefusesReservedSymbolsEmptyRunsAndBadPadding) {
  Bytes bytes = {0x8F, 205, 0, 5, 0, 0, 0, 7, 0, 0, 0, 8, 0, 5, 0, 2, 0, 0, 2, 9, 0x60, 2, 0, 0};
  EXPECT_FALSE(ParseTwcc(View(bytes))) << "a run of the reserved symbol";
  bytes[20] = 0x20;
  EXPECT_TRUE(ParseTwcc(View(bytes)));
  bytes[21] = 0;
  EXPECT_FALSE(ParseTwcc(View(bytes))) << "a run of none";
  bytes[21] = 2;
  bytes[0] |= 0x20;
  bytes[23] = 100;
  EXPECT_FALSE(ParseTwcc(View(bytes))) << "padding that is longer than the packet";
  bytes[0] = 0x4F;
  bytes[23] = 0;
  EXPECT_FALSE(ParseTwcc(View(bytes))) << "version 1";
}

class Mapper : public ::testing::Test {
 protected:
  TwccMapper mapper;
};

TEST_F(Mapper, FindsThePacketsOfTheNumbersAcrossTheWrap) {
  for (int i = 0; i < 6; ++i)
    mapper.OnSent(static_cast<std::uint16_t>(65534 + i), i % 2 == 0 ? 100 : 200,
                  static_cast<std::uint16_t>(65535 + i / 2));
  const auto report = mapper.Map(Report({10ms, 11ms, std::nullopt, 15ms, 12ms}));
  ASSERT_TRUE(report);
  ASSERT_EQ(report->blocks.size(), 2U);
  const SsrcReport& first = report->blocks[0];
  EXPECT_EQ(first.ssrc, 100U);
  EXPECT_EQ(first.begin_seq, 65535);
  ASSERT_EQ(first.metrics.size(), 3U);
  EXPECT_EQ(first.metrics[0].arrival_offset, Duration{5ms});
  EXPECT_EQ(first.metrics[0].ecn, Ecn::kNotEct);
  EXPECT_FALSE(first.metrics[1].received);
  EXPECT_EQ(first.metrics[2].arrival_offset, Duration{3ms});
  ASSERT_EQ(report->blocks[1].metrics.size(), 2U);
  EXPECT_EQ(report->blocks[1].metrics[1].arrival_offset, Duration{0});
  EXPECT_EQ(report->report_timestamp, ReportClock::ToTimestamp(Time{15ms}));
}

TEST_F(Mapper, SaysNothingOfPacketsBetweenThoseOfTheReport) {
  // Number 65535 belongs to somebody else.
  mapper.OnSent(65534, 100, 1);
  mapper.OnSent(0, 100, 5);
  const auto report = mapper.Map(Report({10ms, 11ms, 12ms}));
  ASSERT_TRUE(report);
  ASSERT_EQ(report->blocks.size(), 2U) << "2 to 4 were not reported";
  EXPECT_EQ(report->blocks[0].begin_seq, 1);
  EXPECT_EQ(report->blocks[1].begin_seq, 5);
}

TEST_F(Mapper, IgnoresForgedNumbers) {
  EXPECT_FALSE(mapper.Map(Report({10ms})));
  mapper.OnSent(30000, 100, 1);
  EXPECT_FALSE(mapper.Map(Report({10ms, 11ms})));
  TwccFeedback all = Report(std::vector<std::optional<Duration>>(kMaxTwccPackets, Duration{1s}));
  all.base_number = 29000;
  const auto report = mapper.Map(all);
  ASSERT_TRUE(report);
  ASSERT_EQ(report->blocks.size(), 1U);
  EXPECT_EQ(report->blocks[0].metrics.size(), 1U);
}

TEST_F(Mapper, StartsAnewWhereTheNumbersDo) {
  for (int i = 0; i < 100; ++i)
    mapper.OnSent(static_cast<std::uint16_t>(20000 + i), 100, static_cast<std::uint16_t>(i));
  mapper.OnSent(0, 100, 100);
  TwccFeedback f = Report({10ms});
  f.base_number = 0;
  const auto report = mapper.Map(f);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->blocks[0].begin_seq, 100);
}

TEST_F(Mapper, RemembersNoMoreThanCanBeTold) {
  for (int i = 0; i < 200000; ++i)
    mapper.OnSent(static_cast<std::uint16_t>(i), 100, static_cast<std::uint16_t>(i));
  TwccFeedback f = Report({10ms});
  f.base_number = static_cast<std::uint16_t>(199999);
  EXPECT_TRUE(mapper.Map(f));
  f.base_number = static_cast<std::uint16_t>(199999 - 20000);
  EXPECT_FALSE(mapper.Map(f));
}

TEST_F(Mapper, TimesGoOnWhereTheReferenceWrapsAround) {
  mapper.OnSent(65534, 100, 1);
  mapper.OnSent(65535, 100, 2);
  const auto before = mapper.Map(Report({kTwccPeriod - 10ms}));
  TwccFeedback next = Report({10ms});
  next.base_number = 65535;
  const auto after = mapper.Map(next);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(after->report_timestamp - before->report_timestamp,
              ReportClock::ToTimestamp(Time{20ms}), 1);
}

}  // namespace
}  // namespace lidar::scream
