// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/gaps.h"

#include <gtest/gtest.h>

#include "src/sim/simulated_time.h"

namespace lidar::link {
namespace {
using namespace std::chrono_literals;

/// Returns a link of 8 Mbit/s with two gaps: in the second half of the first second, and in the
/// second half of the third second.
Capacity TwoGaps() {
  return Capacity::Steps({Mbps(8), Mbps(0.2), Mbps(8), Mbps(8), Mbps(8), Mbps(0), Mbps(8)}, 500ms);
}

/// Returns packets that are sent every millisecond from `from` to `until`, at `mbps` in all.
std::vector<SentPacket> Sent(double mbps, Duration from, Duration until) {
  std::vector<SentPacket> packets;
  for (Duration t = from; t < until; t += 1ms) packets.push_back({t, Mbps(mbps) * Duration{1ms}});
  return packets;
}

TEST(Gaps, EndWhereTheCapacityComesBack) {
  EXPECT_EQ(EndsOfGaps(TwoGaps(), 10s), (std::vector<Duration>{1s, 3s}));
  EXPECT_EQ(EndsOfGaps(TwoGaps(), 2s), (std::vector<Duration>{1s}));
  EXPECT_TRUE(EndsOfGaps(Capacity::Constant(Mbps(8)), 10s).empty());
}

TEST(Gaps, ASenderIsBackOnceItFillsTheShareOfWhatIsUsable) {
  EXPECT_EQ(RecoveryAfterGaps(TwoGaps(), Sent(8, 0s, 10s), {10s}), (std::vector<double>{0, 0}));
  const auto late = RecoveryAfterGaps(TwoGaps(), Sent(7, 1300ms, 10s), {10s});
  ASSERT_EQ(late.size(), 2U);
  EXPECT_NEAR(late[0], 0.3, 0.02);
  EXPECT_EQ(late[1], 0);
}

TEST(Gaps, ASourceThatCanUseLessNeedsLess) {
  RecoveryConfig config{10s};
  EXPECT_NEAR(RecoveryAfterGaps(TwoGaps(), Sent(4, 0s, 10s), config)[0], 1.4, 0.05)
      << "never, before the next gap";
  config.source_max = Mbps(5);
  EXPECT_EQ(RecoveryAfterGaps(TwoGaps(), Sent(4, 0s, 10s), config)[0], 0);
}

TEST(Gaps, ThoseThatComeTooCloseAreLeftOut) {
  std::string error;
  const auto c = Capacity::ParseTrace("0 8\n1 0\n1.5 8\n1.65 0\n2 8", false, &error);
  ASSERT_TRUE(c) << error;
  EXPECT_EQ(EndsOfGaps(*c, 10s), (std::vector<Duration>{1500ms, 2s}));
  EXPECT_EQ(RecoveryAfterGaps(*c, Sent(8, 0s, 10s), {10s}).size(), 1U);
}

TEST(Gaps, NobodyIsBackWhoSendsNothing) {
  const auto never = RecoveryAfterGaps(TwoGaps(), {}, {30s});
  ASSERT_EQ(never.size(), 2U);
  EXPECT_NEAR(never[1], 5, 0.2);
}

}  // namespace
}  // namespace lidar::link
