// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/pi2.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "src/link/bottleneck.h"
#include "src/sim/simulated_time.h"

namespace lidar::link {
namespace {
using namespace std::chrono_literals;

struct Share {
  int packets = 0;
  int signalled = 0;
  double sojourn_ms = 0;

  double rate() const { return static_cast<double>(signalled) / packets; }
  double mean_ms() const { return sojourn_ms / packets; }
};

/// Sends the packets of `flows` for 20 s. Each flow sends packets of 1000 bytes at `load` times 8
/// Mbit/s and never slows down. Returns the figures of the last 10 s.
std::array<Share, 4> Overload(AqmConfig::Kind kind, std::vector<Ecn> flows, double load,
                              bool knows_l4s = true) {
  BottleneckConfig config;
  config.origin = kStart;
  config.capacity = Capacity::Constant(DataRate::BitsPerSecond(8e6));
  config.aqm.kind = kind;
  config.aqm.pi2.knows_l4s = knows_l4s;
  Bottleneck link(config);
  std::array<Share, 4> shares;
  const auto spacing = FromSeconds(1e-3 / load);
  for (Time now = kStart; now < kStart + 20s; now += spacing) {
    for (const Ecn ecn : flows)
      link.Enqueue(now, {DataSize::Bytes(1000), ecn, static_cast<std::uint64_t>(ecn)});
    for (const Outcome& o : link.Deliver(now)) {
      if (o.sent < kStart + 10s) continue;
      Share& s = shares[o.packet.id];
      ++s.packets;
      s.signalled += !o.delivered() || static_cast<std::uint64_t>(o.packet.ecn) != o.packet.id;
      s.sojourn_ms += Milliseconds(o.sojourn);
    }
  }
  return shares;
}

TEST(PiController, RisesWhileTheQueueIsAboveItsTargetAndFallsBelow) {
  PiController c{{}};
  c.Update(kStart, 0ms);
  c.Update(kStart + 1s - 1ms, 30ms);
  const double high = c.p();
  // The controller made 62 updates of 0.16 x 15 ms, and one update of 3.2 x 30 ms.
  EXPECT_NEAR(high, 62 * 0.16 * 0.015 + 3.2 * 0.030, 0.003);
  c.Update(kStart + 1500ms, 0ms);
  EXPECT_LT(c.p(), high - 0.09);
}

TEST(PiController, ForgetsAfterAnIdleLink) {
  PiController c{{}};
  c.Update(kStart, 0ms);
  c.Update(kStart + 900ms, 50ms);
  EXPECT_GT(c.p(), 0);
  c.Update(kStart + 30s, 50ms);
  EXPECT_EQ(c.p(), 0);
}

TEST(Pi2, DropsAsMuchAsAnOverloadOf10PercentNeedsToHoldItsTarget) {
  const auto s = Overload(AqmConfig::Kind::kPi2, {Ecn::kNotEct}, 1.1)[0];
  EXPECT_NEAR(s.rate(), 1 - 1 / 1.1, 0.015);
  EXPECT_NEAR(s.mean_ms(), 15, 3);
}

TEST(Pi2, MarksEct1WithTwiceTheRootOfTheClassicSignal) {
  // The same p' holds for both flows. The dropped packets of the classic flow keep the queue at its
  // target.
  const auto s = Overload(AqmConfig::Kind::kPi2, {Ecn::kNotEct, Ecn::kEct1}, 0.525);
  const double p = std::sqrt(s[0].rate());
  EXPECT_NEAR(s[0].rate(), 2 - 2 / 1.05, 0.02);
  EXPECT_NEAR(s[1].rate(), 2 * p, 0.04);
}

TEST(Pi2, MarksEct0InsteadOfDroppingIt) {
  const auto s = Overload(AqmConfig::Kind::kPi2, {Ecn::kEct0, Ecn::kNotEct}, 0.525);
  EXPECT_NEAR(s[2].rate(), s[0].rate(), 0.02);
}

TEST(Pi2, MarksEct1AsRarelyAsEct0WhereItDoesNotKnowL4s) {
  const auto s = Overload(AqmConfig::Kind::kPi2, {Ecn::kEct1, Ecn::kNotEct}, 0.525, false);
  EXPECT_NEAR(s[1].rate(), s[0].rate(), 0.02);
}

TEST(DualPi2, L4sWaitsLittleBesideAStandingClassicQueue) {
  const auto s = Overload(AqmConfig::Kind::kDualPi2, {Ecn::kNotEct, Ecn::kEct1}, 0.525);
  EXPECT_NEAR(s[0].mean_ms(), 15, 3);
  EXPECT_LT(s[1].mean_ms(), 1);
  const double coupled = 2 * std::sqrt(s[0].rate());
  EXPECT_GT(s[1].rate(), coupled - 0.03);
  EXPECT_LT(s[1].rate(), coupled + 0.12) << "a classic packet being sent takes a millisecond";
}

TEST(DualPi2, APacketThatWasMarkedBeforeWaitsAsL4s) {
  const auto s = Overload(AqmConfig::Kind::kDualPi2, {Ecn::kNotEct, Ecn::kCe}, 0.525);
  EXPECT_LT(s[3].mean_ms(), 1);
}

TEST(DualPi2, ClassicIsNotStarvedWhereL4sAloneFillsTheLink) {
  BottleneckConfig config;
  config.origin = kStart;
  config.capacity = Capacity::Constant(DataRate::BitsPerSecond(8e6));
  config.aqm.kind = AqmConfig::Kind::kDualPi2;
  Bottleneck link(config);
  for (int i = 0; i < 300; ++i) link.Enqueue(kStart, {DataSize::Bytes(1000), Ecn::kEct1, 1});
  link.Enqueue(kStart, {DataSize::Bytes(1000), Ecn::kNotEct, 0});
  for (int i = 0; i < 300; ++i)
    link.Enqueue(kStart + i * 1ms, {DataSize::Bytes(1000), Ecn::kEct1, 1});
  for (const Outcome& o : link.Deliver(kStart + 10s))
    if (o.packet.id == 0) {
      EXPECT_EQ(Milliseconds(o.sojourn), 351) << "300 before it, and those of the next 50 ms";
    }
}

TEST(DualPi2, OnlyL4sPacketsAreMarkedByItsOwnRamp) {
  const auto s = Overload(AqmConfig::Kind::kDualPi2, {Ecn::kEct1}, 1.05)[1];
  EXPECT_GT(s.rate(), 0.99) << "nothing makes this flow slow down, so its queue stands";
}

}  // namespace
}  // namespace lidar::link
