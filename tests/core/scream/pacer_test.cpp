// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests how the pacer spaces packets.
#include <gtest/gtest.h>

#include "src/scream/pacer.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream {
namespace {

TEST(Pacer, RelaxesNearTheMaximumBitrate) {
  const Parameters p = Parameters::Draft();
  Pacer pacer(p);
  pacer.Update(Mbps(4), Mbps(10), 1.5);
  EXPECT_NEAR(pacer.pace_bitrate().bits_per_second(), 6e6, 1);
  pacer.Update(Mbps(9), Mbps(10), 1.5);
  EXPECT_NEAR(pacer.pace_bitrate().bits_per_second(), 27e6, 1);
  pacer.Update(Mbps(10), Mbps(10), 1.5);
  EXPECT_NEAR(pacer.pace_bitrate().bits_per_second(), 60e6, 1);
  pacer.Update(Mbps(0.01), Mbps(10), 1.5);
  EXPECT_NEAR(pacer.pace_bitrate().bits_per_second(), 75e3, 1);
}

TEST(Pacer, RelaxesUpToWhatTheLinkCarriesAndIsNeverSlowerThanStrictPacing) {
  const Parameters p = Parameters::Draft();
  Pacer pacer(p);
  pacer.Update(Mbps(5), Mbps(5), 1.5, Mbps(9));
  EXPECT_NEAR(pacer.pace_bitrate().bits_per_second(), 9e6, 1);
  pacer.Update(Mbps(5), Mbps(5), 1.5, Mbps(6));
  EXPECT_NEAR(pacer.pace_bitrate().bits_per_second(), 7.5e6, 1);
}

TEST(Pacer, CatchesUpAfterALateWakeUpButOnlyALittle) {
  const Parameters p;
  Pacer pacer(p);
  pacer.Update(Mbps(8), Mbps(100), 1);
  pacer.OnSent(kStart, DataSize::Bytes(1000));
  EXPECT_EQ(pacer.next(), kStart - 4ms + 1ms);
  for (int i = 0; i < 4; ++i) pacer.OnSent(kStart, DataSize::Bytes(1000));
  EXPECT_EQ(pacer.next(), kStart + 1ms);
  pacer.OnIdleEnd(kStart + 5ms);
  pacer.OnSent(kStart + 5ms, DataSize::Bytes(1000));
  EXPECT_EQ(pacer.next(), kStart + 6ms);
}

TEST(Pacer, WaitsNoLongerForWhatLeftAtTheRateOfAGap) {
  const Parameters p;
  Pacer pacer(p);
  pacer.Update(DataRate::BitsPerSecond(5e4), DataRate::BitsPerSecond(10e6), 1);
  pacer.OnSent(kStart, DataSize::Bytes(1250));
  ASSERT_GT(pacer.next(), kStart + 100ms);
  pacer.OnGapEnd(kStart + 20ms);
  EXPECT_EQ(pacer.next(), kStart + 20ms);
  pacer.OnGapEnd(kStart + 30ms);
  EXPECT_EQ(pacer.next(), kStart + 20ms);
}

TEST(Pacer, HoldsALargeFrameBackUntilTheLinkHasRoomForIt) {
  const Parameters p;
  Pacer pacer(p);
  pacer.Update(Mbps(10), Mbps(100), 1.25);
  pacer.LimitQueue(Mbps(8), 2ms);
  Time at = kStart;
  for (int i = 0; i < 20; ++i) {
    pacer.OnSent(at, DataSize::Bytes(1000));
    at = pacer.next();
  }
  EXPECT_EQ(at, kStart + 18ms) << "each packet takes the link 1 ms, and it may queue two";
  pacer.RaiseTo(Mbps(16));
  pacer.OnSent(at, DataSize::Bytes(1000));
  EXPECT_LT(pacer.next() - at, 1ms) << "a backlog drains faster";
}

TEST(Pacer, ASmallFrameLeavesRoomForALargerOne) {
  const Parameters p;
  Pacer pacer(p);
  pacer.Update(Mbps(10), Mbps(100), 1.25);
  pacer.LimitQueue(Mbps(8), 2ms);
  pacer.OnSent(kStart, DataSize::Bytes(1000));
  pacer.OnIdleEnd(kStart + 20ms);
  pacer.OnSent(kStart + 20ms, DataSize::Bytes(1000));
  EXPECT_EQ(pacer.next(), kStart + 20ms + 640us);
}

/// The gaps between packets come in pairs: one is longer by the ripple, and one is shorter by the
/// ripple. Which of the two is first must not repeat with a period.
TEST(Pacer, GapsAreUnevenByTheRippleAndEvenOnAverage) {
  const Parameters p;
  for (const Duration ripple : {Duration(200us), Duration(10ms)}) {
    Pacer pacer(p);
    pacer.OnIdleEnd(kStart);
    pacer.set_ripple(ripple);
    pacer.Update(Mbps(10), Mbps(100), 1);
    const Duration even = DataSize::Bytes(1250) / Mbps(10);
    Time due = kStart;
    int changes = 0;
    bool longer = false;
    for (int i = 0; i < 64; ++i) {
      pacer.OnSent(due, DataSize::Bytes(1250));
      const Duration gap = pacer.next() - due;
      EXPECT_EQ(gap > even ? gap - even : even - gap, std::min(ripple, even / 2));
      changes += i > 0 && (gap > even) != longer;
      longer = gap > even;
      due = pacer.next();
      if (i % 2 == 1) {
        EXPECT_EQ(due - kStart, (i + 1) * even);
      }
    }
    EXPECT_GT(changes, 32);
    EXPECT_LT(changes, 63);
  }
}

}  // namespace
}  // namespace lidar::scream
