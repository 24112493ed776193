// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests which measurements WindowAfterDrop() takes for a fall of the link's capacity.
#include "src/scream/response/capacity_drop.h"

#include <gtest/gtest.h>

#include "src/sim/simulated_time.h"
#include "tests/core/scream/measured_path.h"

namespace lidar::scream {
namespace {

class CapacityDropTest : public ::testing::Test {
 protected:
  CapacityDropTest() { window_.Set(DataSize::Bytes(100000)); }
  std::optional<DataSize> Update(double target_mbps) {
    return WindowAfterDrop(path_.now, parameters_, path_.model, window_, Mbps(target_mbps), 20ms);
  }
  /// Reports packets that the link delivers at 4 Mbit/s, one every 2 ms. Each packet waits longer
  /// than the one before it by `by`. If `by` is 1 ms, the packets were sent at 8 Mbit/s.
  void HoldBack(int packets, Ecn ecn, Duration by = 1ms) {
    for (int i = 0; i < packets; ++i) path_.Arrive(1, 2ms, queue_ += by, ecn);
  }
  Duration queue_ = 10ms;
  Parameters parameters_;
  Path path_{parameters_};
  ReferenceWindow window_{parameters_};
};

TEST_F(CapacityDropTest, GivesTheWindowThatFillsTheLink) {
  HoldBack(40, Ecn::kCe);
  const auto window = Update(10);
  ASSERT_TRUE(window);
  EXPECT_NEAR(static_cast<double>(window->bytes()), 4e6 / 8 * 0.04 * 1.2, 300);
  window_.Drop(path_.now, *window);
  window_.Set(DataSize::Bytes(100000));
  EXPECT_FALSE(Update(10)) << "once a round trip";
}

TEST_F(CapacityDropTest, LeavesATargetAloneThatTheLinkCarries) {
  HoldBack(40, Ecn::kCe);
  EXPECT_FALSE(Update(3.5));
}

TEST_F(CapacityDropTest, TakesFewMarksForALinkThatIsWellUsedUnlessTheTargetIsFarAboveIt) {
  for (int i = 0; i < 20; ++i) {
    HoldBack(1, Ecn::kCe);
    HoldBack(2, Ecn::kEct1);
  }
  HoldBack(1, Ecn::kCe);
  EXPECT_FALSE(Update(5));
  EXPECT_TRUE(Update(7));
}

TEST_F(CapacityDropTest, TakesMarksOfAShortQueueForWhatTheyAre) {
  Duration queue{0};
  // The queue delay grows to 4 ms.
  for (int i = 0; i < 40; ++i) path_.Arrive(1, 1ms, queue += 100us, Ecn::kCe);
  EXPECT_FALSE(Update(20));
}

/// If packets arrive as far apart as they were sent, their rate may be this flow's own rate beside
/// other flows. It need not be the capacity of the link.
TEST_F(CapacityDropTest, TakesItsOwnRateForNoDropWhereMarksWork) {
  path_.Arrive(40, 2ms, 20ms, Ecn::kCe);
  EXPECT_FALSE(Update(10));
}

TEST_F(CapacityDropTest, NeedsAQueueThatGrewByThreePackets) {
  HoldBack(40, Ecn::kCe, 100us);  // The queue grows by 4 ms, or two gaps of 1.9 ms.
  EXPECT_FALSE(Update(10));
  HoldBack(30, Ecn::kCe, 100us);  // The queue grows to 7 ms, or more than three gaps.
  EXPECT_TRUE(Update(10));
}

/// A link without marks keeps its queue until something else reduces the window. WindowAfterDrop()
/// alone does this.
TEST_F(CapacityDropTest, ShortensAStandingQueueThatNobodyMarks) {
  path_.Arrive(40, 2ms, 50ms, Ecn::kEct1);
  EXPECT_TRUE(Update(10));
}

TEST_F(CapacityDropTest, NeverWidensTheWindow) {
  HoldBack(40, Ecn::kCe);
  window_.Set(DataSize::Bytes(20000));  // The link's rate would give 24,000 bytes.
  EXPECT_FALSE(Update(10));
}

TEST_F(CapacityDropTest, SeesNothingWhereNoPacketWaited) {
  path_.Arrive(40, 2ms, 0ms, Ecn::kEct1);
  EXPECT_FALSE(Update(10));
}

}  // namespace
}  // namespace lidar::scream
