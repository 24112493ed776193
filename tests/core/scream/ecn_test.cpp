// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests what the sender learns from ECN marks: alpha, and whether the path carries ECN.
#include <gtest/gtest.h>

#include "src/scream/model/classic_ecn.h"
#include "src/scream/model/ecn_monitor.h"
#include "src/scream/model/l4s_alpha.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream {
namespace {

TEST(L4sAlpha, RisesAndFallsByASixteenth) {
  const Parameters p = Parameters::Draft();
  L4sAlpha alpha(p);
  alpha.Update(kStart, 10, 5, 40ms, 40ms);
  EXPECT_DOUBLE_EQ(alpha.value(), 0.5 / 16);
  alpha.Update(kStart + 10ms, 10, 0, 40ms, 40ms);
  EXPECT_DOUBLE_EQ(alpha.value(), 0.5 / 16 * 15 / 16);
}

TEST(L4sAlpha, GathersPacketsForTenMilliseconds) {
  const Parameters p = Parameters::Draft();
  L4sAlpha alpha(p);
  alpha.Update(kStart, 1, 0, 40ms, 40ms);
  alpha.Update(kStart + 5ms, 10, 10, 40ms, 40ms);
  EXPECT_DOUBLE_EQ(alpha.value(), 0);
  alpha.Update(kStart + 10ms, 10, 0, 40ms, 40ms);
  EXPECT_DOUBLE_EQ(alpha.value(), 0.5 / 16);
}

TEST(L4sAlpha, TheEvenOneAveragesARoundWithoutBiasAndStillAttacksWhenMostIsMarked) {
  const Parameters p;
  L4sAlpha alpha(p);
  for (int i = 0; i < 1000; ++i) alpha.Update(kStart + i * 10ms, 10, i % 8 == 0, 20ms, 40ms);
  EXPECT_NEAR(alpha.value(), 0.1 / 8, 0.005);
  const double before = alpha.value();
  alpha.Update(kStart + 11s, 0, 0, 20ms, 40ms);  // ends the round that the last packets belong to
  alpha.Update(kStart + 12s, 10, 10, 20ms, 40ms);
  EXPECT_NEAR(alpha.value(), before + (1 - before) / 32, 0.01) << "one round may be a step's";
  const double once = alpha.value();
  alpha.Update(kStart + 12s + 40ms, 10, 10, 20ms, 40ms);
  EXPECT_NEAR(alpha.value(), once + (1 - once) / 8, 1e-9);
}

/// An AQM with a step marks all packets of some rounds and no packet of the other rounds.
TEST(L4sAlpha, TheEvenOneTakesRoundsThatAreMarkedByTurnsForTheirShare) {
  const Parameters p;
  L4sAlpha alpha(p);
  for (int i = 0; i < 1000; ++i) alpha.Update(kStart + i * 40ms, 10, i % 5 ? 0 : 10, 20ms, 40ms);
  EXPECT_NEAR(alpha.value(), 0.2, 0.03);
  alpha.Update(kStart + 50s, 10, 10, 20ms, 40ms);
  alpha.Restore(0.2);
  alpha.Update(kStart + 51s, 10, 10, 20ms, 40ms);
  EXPECT_LT(alpha.value(), 0.24) << "what was before a gap is not in a row with what is after it";
}

TEST(L4sAlpha, TheEvenOneAttacksAtOnceWhereARoundIsLong) {
  const Parameters p;
  L4sAlpha alpha(p);
  alpha.Update(kStart, 50, 40, 20ms, 100ms);
  EXPECT_DOUBLE_EQ(alpha.value(), 0.8 / 8);
}

TEST(L4sAlpha, TheEvenOneFollowsWithinTheSameTimeWhateverTheFrameRate) {
  const Parameters p;
  for (const Duration round : {40ms, 100ms}) {
    L4sAlpha alpha(p);
    for (Duration t{0}; t <= 1300ms; t += round) alpha.Update(kStart + t, 10, 2, 20ms, round);
    EXPECT_NEAR(alpha.value(), 0.2 * 0.64, 0.012) << Milliseconds(round);
  }
}

TEST(EcnMonitor, StaysCapableWhileTheCodepointArrives) {
  EcnMonitor ecn(Ecn::kEct1);
  EXPECT_EQ(ecn.state(), EcnState::kTesting);
  ecn.OnAcked(Ecn::kEct1, Ecn::kEct1);
  EXPECT_EQ(ecn.state(), EcnState::kCapable);
  EXPECT_EQ(ecn.codepoint(), Ecn::kEct1);
  for (int i = 0; i < 19; ++i) ecn.OnAcked(Ecn::kEct1, Ecn::kNotEct);
  EXPECT_EQ(ecn.state(), EcnState::kCapable);
  ecn.OnAcked(Ecn::kEct1, Ecn::kNotEct);
  EXPECT_EQ(ecn.state(), EcnState::kBleached) << "the path has changed";
}

TEST(EcnMonitor, FallsBackWhenTheCodepointIsBleachedAndProbesANewRoute) {
  EcnMonitor ecn(Ecn::kEct1);
  for (int i = 0; i < 20; ++i) ecn.OnAcked(Ecn::kEct1, Ecn::kNotEct);
  EXPECT_EQ(ecn.state(), EcnState::kBleached);
  EXPECT_EQ(ecn.codepoint(), Ecn::kNotEct);
  ecn.Reset();
  EXPECT_EQ(ecn.codepoint(), Ecn::kEct1);
}

TEST(EcnMonitor, TakesAPathThatBleachesSomePacketsForCapable) {
  EcnMonitor ecn(Ecn::kEct1);
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 19; ++i) ecn.OnAcked(Ecn::kEct1, Ecn::kNotEct);
    ecn.OnAcked(Ecn::kEct1, Ecn::kCe);
  }
  EXPECT_EQ(ecn.state(), EcnState::kCapable);
}

/// Sends a packet every 10 ms from `from` to `until`. If `arrives` returns true for the codepoint
/// of a packet, the packet is acknowledged with that codepoint.
template <class Arrives>
void Send(EcnMonitor* ecn, Duration from, Duration until, Arrives arrives) {
  for (Duration t = from; t < until; t += 10ms) {
    const Ecn sent = ecn->codepoint();
    ecn->OnSent(kStart + t, sent);
    if (arrives(sent)) ecn->OnAcked(sent, sent);
    ecn->OnTimer(kStart + t);
  }
}
constexpr auto kNone = [](Ecn) { return false; };
constexpr auto kAll = [](Ecn) { return true; };
constexpr auto kPlain = [](Ecn sent) { return sent == Ecn::kNotEct; };

TEST(EcnMonitor, FallsBackWhereOnlyPacketsWithoutACodepointComeThrough) {
  EcnMonitor ecn(Ecn::kEct1);
  Send(&ecn, 0s, 2s, kPlain);
  EXPECT_EQ(ecn.state(), EcnState::kTesting);
  // From 2 s on, the sender sends every other packet without a codepoint. When ten of these packets
  // have arrived, ECN is known to be the fault.
  Send(&ecn, 2s, 2s + 180ms, kPlain);
  EXPECT_EQ(ecn.state(), EcnState::kTesting);
  Send(&ecn, 2s + 180ms, 2s + 220ms, kPlain);
  EXPECT_EQ(ecn.state(), EcnState::kSilent);
  EXPECT_EQ(ecn.codepoint(), Ecn::kNotEct);
  ecn.Reset();
  EXPECT_EQ(ecn.codepoint(), Ecn::kEct1);
  Send(&ecn, 3s, 4s, kPlain);
  EXPECT_EQ(ecn.state(), EcnState::kTesting) << "another route has another chance";
}

TEST(EcnMonitor, IsCapableAlsoWhereTheReceiverCameLate) {
  EcnMonitor ecn(Ecn::kEct1);
  Send(&ecn, 0s, 60s, kNone);
  EXPECT_EQ(ecn.state(), EcnState::kTesting);
  Send(&ecn, 60s, 61s, kAll);
  EXPECT_EQ(ecn.state(), EcnState::kCapable);
  Send(&ecn, 61s, 70s, kNone);
  Send(&ecn, 70s, 71s, kAll);
  EXPECT_EQ(ecn.state(), EcnState::kCapable) << "a gap says nothing of codepoints";
  EXPECT_EQ(ecn.codepoint(), Ecn::kEct1);
}

TEST(EcnMonitor, FallsBackWhereACapablePathBeginsToDropCodepoints) {
  EcnMonitor ecn(Ecn::kEct1);
  Send(&ecn, 0s, 10s, kAll);
  Send(&ecn, 10s, 12s, kPlain);
  EXPECT_EQ(ecn.state(), EcnState::kCapable);
  Send(&ecn, 12s, 12s + 250ms, kPlain);
  EXPECT_EQ(ecn.state(), EcnState::kSilent);
  EXPECT_EQ(ecn.codepoint(), Ecn::kNotEct);
}

TEST(EcnMonitor, IsNotCalledSilentAfterAPauseOfACapablePath) {
  EcnMonitor ecn(Ecn::kEct1);
  Send(&ecn, 0s, 10s, kAll);
  Send(&ecn, 60s, 61s, kNone);
  EXPECT_EQ(ecn.codepoint(), Ecn::kEct1);
}

TEST(EcnMonitor, IsNotCalledSilentForAFewPacketsAlone) {
  EcnMonitor ecn(Ecn::kEct1);
  for (int i = 0; i < 9; ++i) ecn.OnSent(kStart, Ecn::kEct1);
  ecn.OnTimer(kStart + 1h);
  ecn.OnSent(kStart + 1h, Ecn::kEct1);
  EXPECT_EQ(ecn.codepoint(), Ecn::kEct1);
}

class ClassicEcnTest : public ::testing::Test {
 protected:
  void Run(int packets, Duration lowest, Duration highest, int mark_every) {
    for (int i = 0; i < packets; ++i, now_ += 1ms)
      ecn_.OnPacket(now_, lowest + (highest - lowest) * (i % 100) / 100, i % mark_every == 0);
  }
  ClassicEcn ecn_;
  Time now_ = kStart;
};

TEST_F(ClassicEcnTest, IsFewMarksBehindALongQueue) {
  Run(10000, 5ms, 25ms, 50);
  EXPECT_TRUE(ecn_.found());
  Run(10000, 0ms, 3ms, 10);
  EXPECT_FALSE(ecn_.found());
}

TEST_F(ClassicEcnTest, IsNotALongerRoute) {
  Run(10000, 0ms, 3ms, 10);
  Run(10000, 15ms, 18ms, 10);
  EXPECT_FALSE(ecn_.found());
}

TEST_F(ClassicEcnTest, IsNotAQueueWithoutMarks) {
  Run(100, 0ms, 3ms, 1);
  Run(10000, 5ms, 25ms, 1000000);
  EXPECT_FALSE(ecn_.found());
}

TEST_F(ClassicEcnTest, IsAQueueAboveTheShortestOfTheSecondBefore) {
  for (int second = 0; second < 30; ++second) {
    const Duration delay = second % 2 == 0 ? 5ms : 25ms;
    Run(1000, delay, delay, 50);
  }
  EXPECT_TRUE(ecn_.found());
}

}  // namespace
}  // namespace lidar::scream
