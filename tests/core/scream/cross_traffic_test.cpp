// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests how the sender estimates the share of other flows in a link, and how this share changes its
// window and its pacing.
#include "src/scream/model/cross_traffic.h"

#include <gtest/gtest.h>

#include "src/scream/response/shared_link.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

/// Frames of ten packets, one frame every 20 ms. The packets of a frame are sent about 1 ms apart.
/// Arrival times are rounded to ticks of 1/1024 s, as in a report.
class CrossTrafficTest : public ::testing::Test {
 protected:
  /// Sends packets that take `own` ms each on the link. Before each packet, the link carries the
  /// packets that other flows sent since the packet before it.
  void Send(int frames, double others_share, Duration queue = 20ms, double own = 0.5) {
    for (int i = 0; i < 10 * frames; ++i) {
      if (i % 10 == 0) traffic_.BeginReport();
      const double uneven_ms = (i / 10 * 7 + i) % 3 == 0 ? 1.4 : 0.8;
      const double spacing_ms = i % 10 == 0 ? 20 - 9 : uneven_ms * spacing_;
      sent_ += FromSeconds(spacing_ms / 1e3);
      arrival_ += FromSeconds((own + others_share * spacing_ms) / 1e3);
      Add(sent_, arrival_, queue);
    }
  }
  void Add(Time sent, Time arrival, Duration queue) {
    traffic_.Add({sent, Tick(arrival), DataSize::Bytes(1250)}, queue, congested_);
  }
  static Time Tick(Time t) {
    constexpr double kTicks = 1024;
    return Time{} + FromSeconds(std::floor(Seconds(t.time_since_epoch()) * kTicks) / kTicks);
  }

  CrossTraffic traffic_;
  Time sent_ = kStart, arrival_ = kStart;
  bool congested_ = true;
  double spacing_ = 1;
};

TEST_F(CrossTrafficTest, IsNoneAloneOnALink) {
  Send(500, 0);
  ASSERT_TRUE(traffic_.share());
  EXPECT_NEAR(*traffic_.share(), 0, 0.05);
  EXPECT_FALSE(traffic_.found());
  EXPECT_FALSE(traffic_.unseen());
}

TEST_F(CrossTrafficTest, IsTheOthersShareOfTheLink) {
  for (const double share : {0.4, 0.7}) {
    traffic_ = CrossTraffic();
    Send(500, share);
    ASSERT_TRUE(traffic_.share());
    EXPECT_NEAR(*traffic_.share(), share, 0.05);
    EXPECT_TRUE(traffic_.found());
  }
}

/// The link carries 1250 bytes in 0.5 ms, which is 20 Mbit/s.
TEST_F(CrossTrafficTest, TellsWhatTheLinkCarriesForAll) {
  for (const double share : {0.0, 0.4, 0.7}) {
    traffic_ = CrossTraffic();
    EXPECT_FALSE(traffic_.link_rate());
    Send(500, share);
    ASSERT_TRUE(traffic_.link_rate());
    EXPECT_NEAR(traffic_.link_rate()->bits_per_second() / 1e6, 20, 2) << share;
  }
}

/// Each report has two packets. They are sent 4 ms apart on average.
TEST_F(CrossTrafficTest, OfASlowFlowFewerPacketsAreEnough) {
  int packets = 0;
  for (; packets < 768 && !traffic_.found(); ++packets) {
    if (packets % 2 == 0) traffic_.BeginReport();
    const Duration spacing = packets / 2 % 2 == 0 ? 3ms : 5ms;
    sent_ += spacing;
    arrival_ += 500us + spacing / 2;
    Add(sent_, arrival_, 20ms);
  }
  EXPECT_LT(packets, 300);
}

/// If the link becomes slower, the sender sends its packets further apart, and they arrive further
/// apart.
TEST_F(CrossTrafficTest, TakesNoStepOfTheCapacityForOthers) {
  for (int i = 0; i < 20; ++i) {
    const bool slow = i % 2 == 1;
    spacing_ = slow ? 1.5 : 1;
    Send(50, 0, 20ms, slow ? 1.5 : 0.5);
    EXPECT_FALSE(traffic_.found()) << i;
  }
  EXPECT_NEAR(*traffic_.share(), 0, 0.1);
}

/// If a packet is sent after the packet before it left the queue, it may find the queue empty or
/// nearly empty.
TEST_F(CrossTrafficTest, CountsNoPacketThatMayHaveMetAnIdleLink) {
  Send(500, 1, 1500us);
  EXPECT_FALSE(traffic_.share());
}

TEST_F(CrossTrafficTest, IsNotBelievedAtOnceAndGoesWithTheOthers) {
  Send(50, 0.5);  // five hundred packets
  EXPECT_FALSE(traffic_.found());
  Send(100, 0.5);
  EXPECT_TRUE(traffic_.found());
  Send(1000, 0);
  EXPECT_FALSE(traffic_.found());
}

/// Packets arrive as far apart as they were sent both on an idle link and on a link full of other
/// flows. Without a queue, the sender cannot tell these links apart.
TEST_F(CrossTrafficTest, IsUnknownWithoutAQueue) {
  Send(500, 1, 0ms);
  EXPECT_FALSE(traffic_.share());
  EXPECT_FALSE(traffic_.found());
}

/// Jitter, a longer route and clocks that drift change the measured delay as a queue does.
TEST_F(CrossTrafficTest, IsUnknownWithoutASignOfCongestion) {
  congested_ = false;
  Send(500, 1);
  EXPECT_FALSE(traffic_.share());
  EXPECT_FALSE(traffic_.found());
}

TEST_F(CrossTrafficTest, IsForgottenTenSecondsAfterTheLastCongestion) {
  Send(500, 0.5);
  congested_ = false;
  Send(400, 0.5);  // 8 s
  EXPECT_TRUE(traffic_.found());
  Send(200, 0.5);
  EXPECT_FALSE(traffic_.found());
  EXPECT_FALSE(traffic_.share());
}

TEST_F(CrossTrafficTest, TakesNoGapForOthers) {
  Send(500, 0.5);
  const double before = *traffic_.share();
  for (int i = 0; i < 20; ++i) {
    arrival_ += 300ms;
    sent_ += 1ms;
    Add(sent_, arrival_, 400ms);
  }
  EXPECT_DOUBLE_EQ(*traffic_.share(), before);
}

TEST_F(CrossTrafficTest, IsUnknownWhilePacketsLeaveEvenly) {
  for (int i = 0; i < 5000; ++i) {
    sent_ += 1ms;
    Add(sent_, sent_ + i % 7 * 200us, 20ms);
  }
  EXPECT_FALSE(traffic_.share());
  EXPECT_TRUE(traffic_.unseen());
}

/// A packet that was sent after a pause longer than the queue does not count. So few packets of a
/// slow flow count, and the flow takes long to find other flows.
TEST_F(CrossTrafficTest, IsUnseenWhileFewPacketsTellOfAShareThatIsKnown) {
  Send(50, 0.5);
  ASSERT_GT(traffic_.share().value_or(0), 0.4);
  ASSERT_FALSE(traffic_.found());
  for (int i = 0; i < 100; ++i) {
    Add(sent_ += 20ms, arrival_ += 20ms, 7ms);  // sent after a pause that is longer than the queue
    Add(sent_ += 1ms, arrival_ += 1ms, 7ms);
  }
  EXPECT_FALSE(traffic_.found());
  EXPECT_TRUE(traffic_.unseen());
}

TEST_F(CrossTrafficTest, SkipsPacketsOutOfOrder) {
  Send(500, 0.5);
  const double before = *traffic_.share();
  for (int i = 0; i < 100; ++i) Add(sent_ - i * 10ms, arrival_ - i * 7ms, 20ms);
  EXPECT_DOUBLE_EQ(*traffic_.share(), before);
}

TEST(SharedLink, ABolderWindowIsForEarlyMarksOfAnL4sQueueOnly) {
  // These marks come from the coupling with the queue of a classic flow.
  EXPECT_EQ(EarlyMarking(600us), 0);
  EXPECT_NEAR(EarlyMarking(800us), 0.5, 1e-9);
  EXPECT_EQ(EarlyMarking(1ms), 1);
  EXPECT_GT(EarlyMarking(1500us), 0);
  EXPECT_EQ(EarlyMarking(2ms), 0);
}

TEST(SharedLink, HalfOfTheLinkIsEnoughBesideOthers) {
  EXPECT_EQ(AboveHalf(Mbps(4), Mbps(20)), -1);
  EXPECT_NEAR(AboveHalf(Mbps(9.2), Mbps(20)), 0, 1e-9);
  EXPECT_NEAR(AboveHalf(Mbps(9.5), Mbps(20)), 0.5, 1e-9);
  EXPECT_EQ(AboveHalf(Mbps(16), Mbps(20)), 1);
}

TEST(SharedLink, PacketsLeaveUnevenlyWhereThatAddsNoMarks) {
  EXPECT_EQ(LateMarking(1ms), 0);
  EXPECT_EQ(LateMarking(3ms), 1);
  const Parameters p;
  EXPECT_GT(PacingRipple(p, PathModel(p)), 0ms);
}

TEST(SharedLink, TheDraftAloneIsAsItWas) {
  const Parameters p = Parameters::Draft();
  const Boldness b = BesideOthers(p, PathModel(p), kStart);
  EXPECT_EQ(b.growth, 0.25);
  EXPECT_EQ(b.backoff, 0.25);
  EXPECT_EQ(PacingRipple(p, PathModel(p)), Duration{0});
}

}  // namespace
}  // namespace lidar::scream::test
