// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/worker/lease_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/tools/scan_progress.h"

namespace lidar::worker {
namespace {

using std::chrono::milliseconds;

TEST(LeaseRecord, ComesBackAsItWas) {
  Progress progress = Scan(90);
  progress.pose = {1.25, -3e6, 1e-9, 0.5, 0.5, -0.5, 0.5};
  progress.time = 1'700'000'000'123'456'789;
  progress.from = 12;
  progress.stream = 5;
  const auto read = ParseLeaseRecord(ToJson({"a-1", milliseconds(1500), progress}));
  ASSERT_TRUE(read && read->progress);
  EXPECT_EQ(read->worker, "a-1");
  EXPECT_EQ(read->lease, milliseconds(1500));
  EXPECT_EQ(read->progress->pose, progress.pose);
  EXPECT_FALSE(read->progress->velocity);
  EXPECT_EQ(read->progress->time, progress.time);
  EXPECT_EQ(read->progress->stream, 5U);
  EXPECT_EQ(read->progress->scan, 90U);
  EXPECT_EQ(read->progress->from, 12U);
  EXPECT_FALSE(ParseLeaseRecord(ToJson({"", milliseconds(0), std::nullopt}))->progress);
  EXPECT_EQ(ParseLeaseRecord("")->worker, "") << "a deleted key";
}

TEST(LeaseRecord, KeepsAVelocityThatMakesSense) {
  Progress progress = Scan(90);
  progress.pose[6] = 1;
  progress.velocity = {10, -0.5, 0, 0, 0, 0.25};
  EXPECT_EQ(ParseLeaseRecord(ToJson({"", {}, progress}))->progress->velocity, progress.velocity);
  progress.velocity->at(1) = 1e5;
  const auto read = ParseLeaseRecord(ToJson({"", {}, progress}));
  ASSERT_TRUE(read && read->progress);
  EXPECT_FALSE(read->progress->velocity);
  const auto text = [](const std::string& velocity) {
    return R"({"worker":"a","lease-ms":1,"pose":[1,2,3,0,0,0,1],"velocity":)" + velocity +
           R"(,"time":1,"stream":4,"scan":5,"from":3})";
  };
  EXPECT_TRUE(ParseLeaseRecord(text("[0,0,0,0,0,0]"))->progress->velocity);
  EXPECT_FALSE(ParseLeaseRecord(text(R"(["0",0,0,0,0,0])"))->progress->velocity);
  progress.velocity = {10, 0, 0, 0, 0, 101};
  EXPECT_FALSE(ParseLeaseRecord(ToJson({"", {}, progress}))->progress->velocity);
}

TEST(LeaseRecord, KnowsWhatDoesNotReadBack) {
  Progress good = Scan(90);
  good.from = 12;
  good.pose[6] = 1;
  EXPECT_TRUE(ReadsBack(good));
  for (const auto& spoil : std::vector<std::function<void(Progress*)>>{
           [](Progress* p) { p->pose[0] = std::nan(""); },
           [](Progress* p) { p->pose[1] = INFINITY; }, [](Progress* p) { p->pose[2] = 2e9; },
           [](Progress* p) { p->pose[6] = 0; }, [](Progress* p) { p->from = 91; },
           [](Progress* p) { p->from = 0; }}) {
    Progress bad = good;
    spoil(&bad);
    EXPECT_FALSE(ReadsBack(bad));
    EXPECT_FALSE(ParseLeaseRecord(ToJson({"a", milliseconds(1500), bad})));
  }
}

TEST(LeaseRecord, KnowsTheVelocityBetweenTwoPoses) {
  // In half a second, the robot turns left by 90 degrees on a circle with a radius of 10 m.
  const double half = std::sqrt(0.5);
  Progress before;
  before.time = 1'000'000'000;
  before.pose = {5, 6, 7, 0, 0, half, half};  // looks along y
  Progress after;
  after.time = 1'500'000'000;
  after.pose = {-5, 16, 7, 0, 0, 1, 0};  // looks along -x
  const auto velocity = VelocityBetween(before, after);
  ASSERT_TRUE(velocity);
  const std::array<double, 6> expected = {20 * std::sqrt(2), 0, 0, 0, 0, 3.14159265};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(velocity->at(i), expected[i], 1e-6) << i;
  for (double& value : after.pose) value = -value;
  after.pose = {-5, 16, 7, after.pose[3], after.pose[4], after.pose[5], after.pose[6]};
  EXPECT_NEAR(VelocityBetween(before, after)->at(5), expected[5], 1e-6) << "the same rotation";
  EXPECT_FALSE(VelocityBetween(after, before)) << "time goes back";
  after.time += 1'000'000'000;
  EXPECT_FALSE(VelocityBetween(before, after)) << "too far apart";
  after = before;
  after.time += 1'999'999;
  EXPECT_FALSE(VelocityBetween(before, after)) << "too close";
  after.time = before.time + 2'000'000;
  EXPECT_TRUE(VelocityBetween(before, after));
  after.pose = {5, 6, 7, 0, 0, 0, 1};
  after.time = before.time + 10'000'000;
  EXPECT_FALSE(VelocityBetween(before, after)) << "157 rad/s";
}

using Pose = std::array<double, 7>;

/// Turns a pose by a third of a turn about the axis x = y = z, which moves x to y, y to z and z to
/// x. Turns the axes of the world if `world` is true, and otherwise the axes of the sensor.
Pose Turned(const Pose& p, bool world) {
  const double x = p[3], y = p[4], z = p[5], w = p[6];
  if (world)
    return {p[2],
            p[0],
            p[1],
            (x + w + z - y) / 2,
            (y - z + w + x) / 2,
            (z + y - x + w) / 2,
            (w - x - y - z) / 2};
  return {p[0],
          p[1],
          p[2],
          (w + x + y - z) / 2,
          (w - x + y + z) / 2,
          (w + x - y + z) / 2,
          (w - x - y - z) / 2};
}

Pose OfOtherSign(const Pose& p) { return {p[0], p[1], p[2], -p[3], -p[4], -p[5], -p[6]}; }

TEST(LeaseRecord, KnowsTheVelocityInAnyFrameAndOfEitherSignOfARotation) {
  const double half = std::sqrt(0.5);
  const double speed = 20 * std::sqrt(2);
  Progress before;
  before.time = 1'000'000'000;
  before.pose = {5, 6, 7, 0, 0, half, half};
  Progress after;
  after.time = 1'500'000'000;
  after.pose = {-5, 16, 8, 0, 0, 1, 0};
  std::array<double, 6> expected = {speed, 0, 2, 0, 0, 3.14159265};
  const auto expect = [&](const char* what) {
    const auto velocity = VelocityBetween(before, after);
    ASSERT_TRUE(velocity) << what;
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(velocity->at(i), expected[i], 1e-6) << what;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (int world = 0; world < 3; ++world) {
      for (Progress* progress : {&before, &after}) {
        expect("as it is");
        progress->pose = OfOtherSign(progress->pose);
        expect("of the other sign");
      }
      for (Progress* progress : {&before, &after}) progress->pose = Turned(progress->pose, true);
    }
    for (Progress* progress : {&before, &after}) progress->pose = Turned(progress->pose, false);
    for (const auto begin : {expected.begin(), expected.begin() + 3})
      std::rotate(begin, begin + 1, begin + 3);
  }
}

TEST(LeaseRecord, IsBounded) {
  const auto reads = [](std::size_t name, int lease_ms, std::size_t blanks = 0) {
    return ParseLeaseRecord(R"({"worker":")" + std::string(name, 'a') + R"(","lease-ms":)" +
                            std::to_string(lease_ms) + "}" + std::string(blanks, ' '))
        .has_value();
  };
  EXPECT_TRUE(reads(200, 60'000));
  EXPECT_FALSE(reads(201, 60'000));
  EXPECT_FALSE(reads(200, 60'001));
  const std::size_t size = std::string(R"({"worker":"a","lease-ms":1})").size();
  EXPECT_TRUE(reads(1, 1, 4'096 - size));
  EXPECT_FALSE(reads(1, 1, 4'097 - size));
}

TEST(LeaseRecord, IsDamagedWhereItSaysWhatCannotBe) {
  const std::string begin = R"({"worker":"a","lease-ms":1000)";
  const std::string rest = R"(,"time":1,"stream":4,"scan":5,"from":3})";
  EXPECT_TRUE(ParseLeaseRecord(begin + R"(,"pose":[1,2,3,0,0,0,1])" + rest));
  for (const std::string& text :
       {std::string("x"), std::string("[]"), std::string("{}"), std::string(R"({"worker":"a"})"),
        std::string(R"({"worker":7,"lease-ms":1})"), std::string(R"({"worker":"a","lease-ms":-1})"),
        std::string(R"({"worker":"a","lease-ms":99999999})"), std::string(5000, '['),
        begin + R"(,"pose":[1,2,3,0,0,0])" + rest, begin + R"(,"pose":[1,2,3,0,0,0,0])" + rest,
        begin + R"(,"pose":[1,2,1e300,0,0,0,1])" + rest,
        begin + R"(,"pose":[1,2,"3",0,0,0,1])" + rest,
        begin + R"(,"pose":[1,2,3,0,0,1,"0"])" + rest,
        begin + R"(,"pose":[1,2,3,0,0,0,1],"time":1,"stream":4,"scan":5,"from":9})",
        begin + R"(,"pose":[1,2,3,0,0,0,1],"time":1,"stream":4,"scan":5})"})
    EXPECT_FALSE(ParseLeaseRecord(text)) << text.substr(0, 100);
}

}  // namespace
}  // namespace lidar::worker
