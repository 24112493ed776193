// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cdr/messages.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/core/cdr/bytes.h"

namespace lidar::cdr {
namespace {

const Header kHeader = {Time{} + Duration{1'700'000'000'123'456'789}, "map"};

Imu AnImu() {
  Imu imu;
  imu.header = kHeader;
  imu.orientation = {0.1, 0.2, 0.3, 0.4};
  imu.angular_velocity = {1, 2, 3};
  imu.linear_acceleration = {0.5, -0.5, 9.81};
  std::iota(imu.linear_acceleration_covariance.begin(), imu.linear_acceleration_covariance.end(),
            7.);
  return imu;
}

Odometry AnOdometry() {
  Odometry o;
  o.header = kHeader;
  o.child_frame_id = "base_link";
  o.position = {10, -20, 30};
  o.orientation = {0, 0, 0.6, 0.8};
  o.linear_velocity = {5, 0, 0};
  o.angular_velocity = {0, 0, 0.25};
  std::iota(o.pose_covariance.begin(), o.pose_covariance.end(), 100.);
  return o;
}

Transforms TwoTransforms() {
  return {{kHeader, "base_link", {1, 2, 3}, {0, 0, 0, 1}},
          {{Time{}, ""}, "a", {4, 5, 6}, {0.5, 0.5, 0.5, 0.5}}};
}

TEST(Messages, ImuComesBack) {
  const Bytes bytes = WriteImu(AnImu());
  const auto imu = ReadImu(View(bytes));
  ASSERT_TRUE(imu);
  EXPECT_EQ(imu->header.stamp, kHeader.stamp);
  EXPECT_EQ(imu->header.frame_id, "map");
  EXPECT_EQ(imu->orientation, AnImu().orientation);
  EXPECT_EQ(imu->orientation_covariance[0], -1);
  EXPECT_EQ(imu->angular_velocity, AnImu().angular_velocity);
  EXPECT_EQ(imu->linear_acceleration, AnImu().linear_acceleration);
  EXPECT_EQ(imu->linear_acceleration_covariance, AnImu().linear_acceleration_covariance);
  // Header, then 37 doubles aligned to 8.
  EXPECT_EQ(bytes.size(), 4u + 16 + 37 * 8);
}

TEST(Messages, OdometryComesBack) {
  const Bytes bytes = WriteOdometry(AnOdometry());
  const auto o = ReadOdometry(View(bytes));
  ASSERT_TRUE(o);
  EXPECT_EQ(o->child_frame_id, "base_link");
  EXPECT_EQ(o->position, AnOdometry().position);
  EXPECT_EQ(o->orientation, AnOdometry().orientation);
  EXPECT_EQ(o->pose_covariance, AnOdometry().pose_covariance);
  EXPECT_EQ(o->linear_velocity, AnOdometry().linear_velocity);
  EXPECT_EQ(o->angular_velocity, AnOdometry().angular_velocity);
}

TEST(Messages, TransformsComeBack) {
  const Bytes bytes = WriteTransforms(TwoTransforms());
  const auto transforms = ReadTransforms(View(bytes));
  ASSERT_TRUE(transforms);
  ASSERT_EQ(transforms->size(), 2u);
  EXPECT_EQ((*transforms)[0].header.stamp, kHeader.stamp);
  EXPECT_EQ((*transforms)[0].child_frame_id, "base_link");
  EXPECT_EQ((*transforms)[1].translation, (Vector3{4, 5, 6}));
  EXPECT_EQ((*transforms)[1].rotation, (Quaternion{0.5, 0.5, 0.5, 0.5}));
}

TEST(Messages, StampsOutsideOfTheirRangeBecomeItsEnds) {
  Transforms t = TwoTransforms();
  t[0].header.stamp = Time{} - Duration{5};
  t[1].header.stamp = Time::max();
  const Bytes bytes = WriteTransforms(t);
  const auto read = ReadTransforms(View(bytes));
  ASSERT_TRUE(read);
  EXPECT_EQ((*read)[0].header.stamp, Time{});
  EXPECT_EQ((*read)[1].header.stamp, Time{} + Duration{2'147'483'647'999'999'999});
}

TEST(Messages, TruncatedOnesAreRefusedAtEachLength) {
  const Bytes imu = WriteImu(AnImu());
  for (std::size_t n = 0; n < imu.size(); ++n) ASSERT_FALSE(ReadImu({imu.data(), n})) << n;
  const Bytes odometry = WriteOdometry(AnOdometry());
  for (std::size_t n = 0; n < odometry.size(); ++n)
    ASSERT_FALSE(ReadOdometry({odometry.data(), n})) << n;
  const Bytes transforms = WriteTransforms(TwoTransforms());
  for (std::size_t n = 0; n < transforms.size(); ++n)
    ASSERT_FALSE(ReadTransforms({transforms.data(), n})) << n;
}

TEST(Messages, ASequenceLongerThanItsMessageTakesNoMemory) {
  Bytes bytes = WriteTransforms(TwoTransforms());
  bytes[7] = 0x40;  // 2^30 transforms more
  EXPECT_FALSE(ReadTransforms(View(bytes)));
}

}  // namespace
}  // namespace lidar::cdr
