// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests how transport-wide feedback is mapped to the packets of each stream.
#include "src/rtcp/twcc_mapper.h"

#include <gtest/gtest.h>

namespace lidar::rtcp {
namespace {

using namespace std::chrono_literals;

TwccFeedback Report(std::vector<std::optional<Duration>> arrivals) {
  return {65534, std::move(arrivals)};
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
  // The packet 65535 belongs to another stream.
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

TEST_F(Mapper, AReportOfLossesAloneHasTheTimeOfTheNewestArrival) {
  mapper.OnSent(65534, 100, 1);
  mapper.OnSent(65535, 100, 2);
  const auto before = mapper.Map(Report({10s}));
  TwccFeedback lost = Report({std::nullopt});
  lost.base_number = 65535;
  const auto after = mapper.Map(lost);
  ASSERT_TRUE(before && after);
  EXPECT_FALSE(after->blocks.at(0).metrics.at(0).received);
  EXPECT_EQ(after->report_timestamp, before->report_timestamp);
}

TEST_F(Mapper, AReportThatWasOvertakenIsNotTheNewestArrival) {
  for (std::uint16_t i = 0; i < 3; ++i)
    mapper.OnSent(static_cast<std::uint16_t>(65534 + i), 100, i);
  TwccFeedback next = Report({20s});
  next.base_number = 65535;
  const auto newest = mapper.Map(next);
  mapper.Map(Report({10s}));
  TwccFeedback lost = Report({std::nullopt});
  lost.base_number = 0;
  const auto after = mapper.Map(lost);
  ASSERT_TRUE(newest && after);
  EXPECT_EQ(after->report_timestamp, newest->report_timestamp);
}

TEST_F(Mapper, AReportThatWasOvertakenAcrossTheWrapIsTheEarlierOne) {
  mapper.OnSent(65534, 100, 1);
  mapper.OnSent(65535, 100, 2);
  TwccFeedback next = Report({10ms});
  next.base_number = 65535;
  const auto after = mapper.Map(next);
  const auto before = mapper.Map(Report({kTwccPeriod - 10ms}));
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(static_cast<std::int32_t>(after->report_timestamp - before->report_timestamp),
              ReportClock::ToTimestamp(Time{20ms}), 1);
}

}  // namespace
}  // namespace lidar::rtcp
