// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/transform_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace lidar {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time kStart = Time{} + seconds(1'700'000'000);
const double kHalf = std::sqrt(0.5);
constexpr FramePose kNowhere{};

FramePose At(double x, double y = 0, double z = 0) { return {{x, y, z}, {0, 0, 0, 1}}; }
FramePose TurnedLeft(double x = 0) { return {{x, 0, 0}, {0, 0, kHalf, kHalf}}; }  // turned about z

/// Returns the coordinates in the target frame of a point `p` in the source frame.
std::array<double, 3> Place(const TransformTree::Answer& answer, std::array<double, 3> p) {
  const Transform t = answer.transform.value();
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = t[4 * i] * p[0] + t[4 * i + 1] * p[1] + t[4 * i + 2] * p[2] + t[4 * i + 3];
  return out;
}

void ExpectNear(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-9) << i;
}

class Tree : public ::testing::Test {
 protected:
  /// The tree is map <- odom <- base <- lidar, and base <- camera.
  void SetUp() override {
    ASSERT_TRUE(tree_.Set("map", "odom", kStart, At(100), false));
    ASSERT_TRUE(tree_.Set("odom", "base", kStart, TurnedLeft(10), false));
    ASSERT_TRUE(tree_.Set("base", "lidar", Time{}, At(1), true));
    ASSERT_TRUE(tree_.Set("base", "camera", Time{}, At(0, 0, 2), true));
  }
  TransformTree tree_;
};

TEST_F(Tree, GoesUpAndDownAndAcross) {
  ExpectNear(Place(tree_.Find("map", "lidar", kStart), {1, 0, 0}), {110, 2, 0});
  ExpectNear(Place(tree_.Find("lidar", "map", kStart), {110, 2, 0}), {1, 0, 0});
  ExpectNear(Place(tree_.Find("camera", "lidar", kStart), {0, 0, 0}), {1, 0, -2});
  ExpectNear(Place(tree_.Find("lidar", "lidar", kStart), {4, 5, 6}), {4, 5, 6});
}

TEST_F(Tree, WhatHoldsForGoodHoldsAtAnyTime) {
  ExpectNear(Place(tree_.Find("base", "lidar", kStart + seconds(9999)), {0, 0, 0}), {1, 0, 0});
  ExpectNear(Place(tree_.Find("base", "lidar", Time{}), {0, 0, 0}), {1, 0, 0});
}

TEST_F(Tree, BetweenTwoPosesItInterpolatesByTheShorterTurn) {
  ASSERT_TRUE(tree_.Set("map", "odom", kStart + milliseconds(100), At(102), false));
  FramePose turned = TurnedLeft(20);
  turned.orientation = {0, 0, -1, 0};  // half a turn, as the negative of the usual quaternion
  ASSERT_TRUE(tree_.Set("odom", "base", kStart + milliseconds(100), turned, false));
  const auto found = tree_.Find("map", "base", kStart + milliseconds(50));
  ExpectNear(Place(found, {0, 0, 0}), {116, 0, 0});
  // The frame is turned by 135 degrees.
  ExpectNear(Place(found, {1, 0, 0}), {116 - kHalf, kHalf, 0});
  // The orientations may be nearly equal, too.
  TransformTree still;
  still.Set("a", "b", kStart, kNowhere, false);
  still.Set("a", "b", kStart + milliseconds(10), At(1), false);
  ExpectNear(Place(still.Find("a", "b", kStart + milliseconds(5)), {0, 0, 1}), {0.5, 0, 1});
}

TEST_F(Tree, GoesBackAndByWayOfOthersAsItGoesThere) {
  FramePose turned = TurnedLeft(20);
  turned.orientation = {0.5, 0.5, 0.5, 0.5};
  ASSERT_TRUE(tree_.Set("map", "odom", kStart + milliseconds(100), At(102, 1), false));
  ASSERT_TRUE(tree_.Set("odom", "base", kStart + milliseconds(100), turned, false));
  const auto frames = {"map", "odom", "base", "lidar", "camera"};
  const std::array<double, 3> point = {1, 2, 3};
  for (const int ms : {-100, 0, 30, 100, 200})
    for (const char* a : frames)
      for (const char* b : frames) {
        const Time time = kStart + milliseconds(ms);
        const auto there = tree_.Find(a, b, time);
        const auto back = tree_.Find(b, a, time);
        SCOPED_TRACE(std::string(a) + " " + b + " " + std::to_string(ms));
        ASSERT_EQ(there.transform.has_value(), back.transform.has_value());
        EXPECT_EQ(there.why, back.why);
        EXPECT_EQ(there.may_come, back.may_come);
        if (!there.transform) continue;
        const auto placed = Place(there, point);
        ExpectNear(Place(back, placed), point);
        for (const char* c : frames) {
          const auto from = tree_.Find(c, b, time);
          const auto on = tree_.Find(a, c, time);
          if (from.transform && on.transform) ExpectNear(Place(on, Place(from, point)), placed);
        }
      }
}

TEST_F(Tree, WithoutATimeTheNewestCounts) {
  ASSERT_TRUE(tree_.Set("map", "odom", kStart + seconds(1), At(200), false));
  ExpectNear(Place(tree_.Find("map", "lidar", std::nullopt), {0, 0, 0}), {210, 1, 0});
}

TEST_F(Tree, SaysWhatIsMissingAndWhetherItMayCome) {
  auto answer = tree_.Find("map", "radar", kStart);
  EXPECT_FALSE(answer.transform);
  EXPECT_TRUE(answer.may_come);
  EXPECT_EQ(answer.why, "no transform names the frame radar");
  tree_.Set("earth", "moon", kStart, kNowhere, true);
  EXPECT_EQ(tree_.Find("moon", "lidar", kStart).why, "no transforms connect lidar with moon");
  answer = tree_.Find("map", "lidar", kStart + milliseconds(250));
  EXPECT_TRUE(answer.may_come);
  EXPECT_EQ(answer.newest, kStart);
  EXPECT_EQ(answer.why, "the newest transform from base to odom is 0.250 s older than the cloud");
  answer = tree_.Find("map", "lidar", kStart - milliseconds(250));
  EXPECT_FALSE(answer.may_come);
  EXPECT_EQ(answer.why, "the cloud is 0.250 s older than the oldest transform from base to odom");
}

TEST_F(Tree, KeepsPosesInTheOrderOfTheirTimes) {
  TransformTree tree;
  const auto set = [&](int ms, double x) {
    ASSERT_TRUE(tree.Set("a", "b", kStart + milliseconds(ms), At(x), false));
  };
  const auto x_at = [&](int ms) {
    return Place(tree.Find("a", "b", kStart + milliseconds(ms)), {0, 0, 0})[0];
  };
  for (const int ms : {0, 20, 10}) set(ms, ms * ms);
  for (const auto& [ms, x] :
       {std::pair(5, 50), std::pair(10, 100), std::pair(15, 250), std::pair(20, 400)})
    EXPECT_NEAR(x_at(ms), x, 1e-9) << ms;
  set(10, 200);  // replaces the first pose at this time
  for (const auto& [ms, x] :
       {std::pair(5, 100), std::pair(10, 200), std::pair(15, 300), std::pair(20, 400)})
    EXPECT_NEAR(x_at(ms), x, 1e-9) << ms;
}

TEST_F(Tree, ForgetsWhatIsOld) {
  TransformTree tree;
  tree.Set("a", "b", kStart, At(1), false);
  tree.Set("a", "b", kStart + seconds(11), At(2), false);
  EXPECT_FALSE(tree.Find("a", "b", kStart + seconds(5)).transform);
}

TEST_F(Tree, APoseThatIsTooLateChangesNothing) {
  ASSERT_TRUE(tree_.Set("map", "odom", kStart + seconds(1), At(200), false));
  EXPECT_FALSE(tree_.Set("map", "odom", kStart - seconds(10), At(3), false));
  EXPECT_FALSE(tree_.Set("elsewhere", "odom", kStart - seconds(10), At(3), false));
  ExpectNear(Place(tree_.Find("map", "odom", kStart + milliseconds(500)), {0, 0, 0}), {150, 0, 0});
  // Newer poses arrive between the old poses, so even many old poses change nothing.
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(tree_.Set("map", "odom", kStart - seconds(20) + milliseconds(i), At(3), false));
    EXPECT_TRUE(tree_.Set("map", "odom", kStart + seconds(1) + milliseconds(i), At(200), false));
  }
  ExpectNear(Place(tree_.Find("map", "odom", kStart), {0, 0, 0}), {100, 0, 0});
}

TEST_F(Tree, AClockThatWentBackBeginsAnew) {
  constexpr auto kAgain = static_cast<int>(TransformTree::kRestart);
  const Time again = kStart - seconds(100);
  for (int i = 0; i < kAgain; ++i)
    EXPECT_EQ(tree_.Set("map", "odom", again + milliseconds(10 * i), At(i), false), i == kAgain - 1)
        << i;
  // The tree now has all poses of the new time. The poses of the old time are gone.
  ExpectNear(Place(tree_.Find("map", "odom", again + milliseconds(15)), {0, 0, 0}), {1.5, 0, 0});
  EXPECT_TRUE(tree_.Find("map", "odom", kStart).may_come);
}

TEST_F(Tree, AClockThatWentBackIsSeenHoweverRareThePosesAre) {
  constexpr auto kAgain = static_cast<int>(TransformTree::kRestart);
  const Time again = kStart - seconds(100);
  for (int i = 0; i < kAgain; ++i)
    EXPECT_EQ(tree_.Set("map", "odom", again + seconds(2 * i), At(i), false), i == kAgain - 1) << i;
  // The poses at the old time are later, but must not make the tree forget poses of the new time.
  ExpectNear(Place(tree_.Find("map", "odom", again + seconds(9)), {0, 0, 0}), {4.5, 0, 0});
  EXPECT_FALSE(tree_.Find("map", "odom", again + seconds(7)).transform);
  // After the restart, any time may pass between two poses.
  for (int i = 0; i < 10; ++i)
    EXPECT_TRUE(tree_.Set("map", "odom", again + seconds(40 + 20 * i), At(i), false)) << i;
}

TEST_F(Tree, AClockThatWentBackIsSeenWhateverThePosesHold) {
  constexpr auto kAgain = static_cast<int>(TransformTree::kRestart);
  const Time again = kStart - seconds(100);
  // All poses have the same stamp.
  for (int i = 0; i < kAgain; ++i)
    EXPECT_EQ(tree_.Set("map", "odom", again, At(i), false), i == kAgain - 1) << i;
  ExpectNear(Place(tree_.Find("map", "odom", again), {0, 0, 0}), {kAgain - 1., 0, 0});
  // Two publishers disagree on the parent of the frame.
  for (int i = 0; i < kAgain; ++i)
    EXPECT_EQ(tree_.Set(i % 2 == 0 ? "map" : "odom", "base", again + seconds(i), At(i), false),
              i == kAgain - 1)
        << i;
  ExpectNear(Place(tree_.Find("odom", "base", again + seconds(9)), {0, 0, 0}), {9, 0, 0});
  // The stamps are not in order. After the restart, poses that are too old relative to the newest
  // pose are refused.
  const Time earlier = again - seconds(100);
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(tree_.Set("map", "odom", earlier - seconds(11 * (i % 5)), At(i), false),
              i == kAgain - 1 || (i >= kAgain && i % 5 == 0))
        << i;
}

TEST_F(Tree, AClockThatWentBackTwiceLeavesNoPoseOfTheFirstTime) {
  constexpr auto kAgain = static_cast<int>(TransformTree::kRestart);
  const auto set_old = [&](Time begin, int count, double x) {
    for (int i = 0; i < count; ++i) tree_.Set("map", "odom", begin + milliseconds(i), At(x), false);
  };
  const Time first = kStart - seconds(20);
  set_old(first, kAgain - 1, 3);
  // The clock continues in the old time.
  ASSERT_TRUE(tree_.Set("map", "odom", kStart, At(100), false));
  set_old(first + seconds(5), kAgain, 7);
  ExpectNear(Place(tree_.Find("map", "odom", first + seconds(5)), {0, 0, 0}), {7, 0, 0});
  EXPECT_FALSE(tree_.Find("map", "odom", first + seconds(1)).transform);
}

TEST_F(Tree, APoseForGoodTakesThePlaceOfAnyOther) {
  // A driver that is restarted may send its pose with an earlier stamp.
  ASSERT_TRUE(tree_.Set("base", "lidar", kStart, At(2), true));
  ASSERT_TRUE(tree_.Set("base", "lidar", kStart - seconds(5), At(3), true));
  ExpectNear(Place(tree_.Find("base", "lidar", kStart), {0, 0, 0}), {3, 0, 0});
  // A frame that begins to move has no pose before the first moving pose.
  ASSERT_TRUE(tree_.Set("base", "lidar", kStart, At(4), false));
  ExpectNear(Place(tree_.Find("base", "lidar", kStart), {0, 0, 0}), {4, 0, 0});
  EXPECT_FALSE(tree_.Find("base", "lidar", kStart - seconds(1)).transform);
  ASSERT_TRUE(tree_.Set("base", "lidar", kStart - seconds(1), At(5), true));
  ExpectNear(Place(tree_.Find("base", "lidar", kStart + seconds(1)), {0, 0, 0}), {5, 0, 0});
}

TEST_F(Tree, AFrameThatMovesToAnotherParentLeavesTheFirst) {
  ASSERT_TRUE(tree_.Set("odom", "lidar", kStart, At(7), false));
  ExpectNear(Place(tree_.Find("odom", "lidar", kStart), {0, 0, 0}), {7, 0, 0});
  // The frame has another parent from 2 s on. Between poses with different parents, the tree does
  // not interpolate.
  ASSERT_TRUE(tree_.Set("map", "base", kStart + seconds(2), At(40), false));
  EXPECT_FALSE(tree_.Find("map", "base", kStart + seconds(1)).transform);
}

TEST_F(Tree, TakesNamesWithTheSlashOfRos1) {
  ASSERT_TRUE(tree_.Set("/base", "/imu", kStart, At(5), true));
  ExpectNear(Place(tree_.Find("base", "/imu", kStart), {0, 0, 0}), {5, 0, 0});
  ExpectNear(Place(tree_.Find("/base", "imu", kStart), {0, 0, 0}), {5, 0, 0});
}

TEST_F(Tree, RefusesWhatIsNoPose) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(tree_.Set("a", "b", kStart, {{nan, 0, 0}, {0, 0, 0, 1}}, false));
  EXPECT_FALSE(tree_.Set("a", "b", kStart, At(1e300), false));
  EXPECT_FALSE(tree_.Set("a", "b", kStart, {{0, 0, 0}, {0, 0, nan, 1}}, false));
  EXPECT_FALSE(tree_.Set("a", "b", kStart, {{0, 0, 0}, {0, 0, 0, 0}}, false));
  EXPECT_FALSE(tree_.Set("a", "b", kStart, {{0, 0, 0}, {0, 0, 1, 1}}, false));
  EXPECT_FALSE(tree_.Set("a", "a", kStart, kNowhere, false));
  EXPECT_FALSE(tree_.Set("", "a", kStart, kNowhere, false));
  EXPECT_FALSE(tree_.Set("a", "/", kStart, kNowhere, false));
  EXPECT_EQ(tree_.frames(), 4U);
}

TEST_F(Tree, ACircleConnectsNothingElse) {
  TransformTree tree;
  tree.Set("a", "b", kStart, kNowhere, true);
  tree.Set("b", "a", kStart, At(1), true);
  EXPECT_FALSE(tree.Find("c", "a", kStart).transform);
  EXPECT_TRUE(tree.Find("b", "a", kStart).transform);
}

TEST(TreeOfStrangers, IsBounded) {
  TransformTree tree;
  for (std::size_t i = 0; i < 2 * TransformTree::kMaxFrames; ++i)
    EXPECT_EQ(tree.Set("root", "f" + std::to_string(i), kStart, kNowhere, false),
              i < TransformTree::kMaxFrames);
  for (std::size_t i = 0; i < 2 * TransformTree::kMaxSamples; ++i)
    ASSERT_TRUE(tree.Set("root", "f0", kStart + std::chrono::microseconds(i), kNowhere, false));
  EXPECT_EQ(tree.frames(), TransformTree::kMaxFrames);
  const Time first_kept = kStart + std::chrono::microseconds(TransformTree::kMaxSamples);
  EXPECT_TRUE(tree.Find("root", "f0", first_kept).transform);
  EXPECT_FALSE(tree.Find("root", "f0", first_kept - std::chrono::microseconds(1)).transform);
}

}  // namespace
}  // namespace lidar
