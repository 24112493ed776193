// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cdr/motion_samples.h"

#include <gtest/gtest.h>

#include "src/base/byte_writer.h"
#include "src/base/pose_bytes.h"

namespace lidar::cdr {
namespace {

using Bytes = std::vector<std::uint8_t>;

ByteView View(const Bytes& bytes) { return {bytes.data(), bytes.size()}; }

TEST(ImuSamples, HaveTimeAccelerationsAndTurnRatesInTheirOrder) {
  Imu imu;
  imu.header.stamp = Time{} + Duration{77};
  imu.linear_acceleration = {1, 2, 3};
  imu.angular_velocity = {4, 5, 6};
  Bytes expected;
  ByteWriter w(&expected);
  w.Le64(77);
  for (const float v : {1.F, 2.F, 3.F, 4.F, 5.F, 6.F}) w.LeF32(v);
  EXPECT_EQ(WriteImuSample(imu), expected);
  Bytes two = expected;
  two.insert(two.end(), expected.begin(), expected.end());
  const auto back = ReadImuSamples(View(two));
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[1].header.stamp, imu.header.stamp);
  EXPECT_EQ(back[1].linear_acceleration, imu.linear_acceleration);
  EXPECT_EQ(back[1].angular_velocity, imu.angular_velocity);
  two.pop_back();
  EXPECT_TRUE(ReadImuSamples(View(two)).empty());
  imu.header.stamp = Time{} - Duration{1};
  EXPECT_EQ(ReadImuSamples(View(WriteImuSample(imu)))[0].header.stamp, Time{});
}

TEST(Poses, HavePositionOrientationAndTracking) {
  Odometry o;
  o.position = {1, 2, 3};
  o.orientation = {0, 0, 0.6, 0.8};
  Bytes expected;
  ByteWriter w(&expected);
  for (const double v : {1., 2., 3., 0., 0., 0.6, 0.8}) w.LeF64(v);
  w.Le64(3);
  EXPECT_EQ(WritePose(o, 3), expected);
  std::uint64_t tracking = 0;
  const auto back = ReadPose(View(expected), &tracking);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->position, o.position);
  EXPECT_EQ(back->orientation, o.orientation);
  EXPECT_EQ(tracking, 3U);
  EXPECT_EQ(back->pose_covariance, o.pose_covariance);
  expected.push_back(0);
  EXPECT_FALSE(ReadPose(View(expected), &tracking));
}

TEST(Poses, BringTheirCovarianceWhereItIsKnown) {
  Odometry o;
  for (std::size_t i = 0; i < 36; ++i) o.pose_covariance[i] = 0.5 + static_cast<double>(i);
  Bytes bytes = WritePose(o, 1);
  EXPECT_EQ(bytes.size(), kPoseSizeWithCovariance);
  std::uint64_t tracking = 0;
  const auto back = ReadPose(View(bytes), &tracking);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->pose_covariance, o.pose_covariance);
  bytes.pop_back();
  EXPECT_FALSE(ReadPose(View(bytes), &tracking));
  for (std::size_t i = 0; i < 36; ++i) {
    Odometry one;
    one.pose_covariance[i] = 1e-9;
    EXPECT_EQ(WritePose(one, 1).size(), kPoseSizeWithCovariance) << i;
  }
}

}  // namespace
}  // namespace lidar::cdr
