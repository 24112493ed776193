// SPDX-License-Identifier: LGPL-2.1-or-later
// What messages become and are made of, without a network.
#include <gtest/gtest.h>

#include "ext/ros2/message_reader.h"
#include "ext/ros2/motion_buffer.h"
#include "gst/common/buffer_map.h"
#include "gst/common/gstlidar.h"
#include "src/base/byte_writer.h"

namespace lidar::gst {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Verdict = MessageReader::Verdict;

ByteView View(const Bytes& bytes) { return {bytes.data(), bytes.size()}; }

class CloudMessages : public ::testing::Test {
 protected:
  CloudMessages() {
    cloud_.header = {Time{} + Duration{1'700'000'000'000'000'005}, "os"};
    cloud_.layout = {1, 2, {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}}, false, 12, 24};
    cloud_.is_dense = true;
  }
  Verdict Read(std::size_t size = 24) {
    const Bytes points(size, 1);
    cloud_.data = View(points);
    return reader_.Read(View(cdr::WritePointCloud2(cloud_)));
  }
  /// A field of the caps that are new; empty where none are.
  std::string NewField(const char* name) {
    const CapsPtr caps = reader_.TakeNewCaps();
    if (!caps) return "";
    const GValue* value = gst_structure_get_value(gst_caps_get_structure(caps.get(), 0), name);
    const StringPtr text(G_VALUE_HOLDS_STRING(value) ? g_value_dup_string(value)
                                                     : gst_value_serialize(value));
    return text.get();
  }

  cdr::PointCloud2 cloud_;
  CapsPtr wanted_;
  MessageReader reader_{cdr::RosType::kPointCloud2, [this] {
                          return CapsPtr(wanted_ ? gst_caps_ref(wanted_.get()) : nullptr);
                        }};
};

TEST_F(CloudMessages, HaveNewCapsWhereAnythingOfThemChanges) {
  ASSERT_EQ(Read(), Verdict::kBuffer);
  EXPECT_EQ(NewField("frame-id"), "os");
  ASSERT_EQ(Read(), Verdict::kBuffer);
  EXPECT_EQ(NewField("frame-id"), "");
  cloud_.header.frame_id = "other";
  ASSERT_EQ(Read(), Verdict::kBuffer);
  EXPECT_EQ(NewField("frame-id"), "other");
  cloud_.is_dense = false;
  ASSERT_EQ(Read(), Verdict::kBuffer);
  EXPECT_EQ(NewField("is-dense"), "false");
  cloud_.layout.width = 3;
  cloud_.layout.row_step = 36;
  ASSERT_EQ(Read(36), Verdict::kBuffer);
  EXPECT_EQ(NewField("width"), "3");
}

TEST_F(CloudMessages, HaveTheirStampUnlessItIsZero) {
  ASSERT_EQ(Read(), Verdict::kBuffer);
  const BufferPtr stamped = reader_.TakeBuffer();
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(stamped.get()), 1'700'000'000'000'000'005U);
  cloud_.header.stamp = Time{};
  ASSERT_EQ(Read(), Verdict::kBuffer);
  const BufferPtr unstamped = reader_.TakeBuffer();
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(unstamped.get()), GST_CLOCK_TIME_NONE);
}

TEST_F(CloudMessages, WithoutRowsOrColumnsAreEmpty) {
  cloud_.layout.width = 0;
  EXPECT_EQ(Read(0), Verdict::kEmpty);
  cloud_.layout.width = 2;
  cloud_.layout.height = 0;
  EXPECT_EQ(Read(0), Verdict::kEmpty);
}

TEST_F(CloudMessages, OfAWrongLengthAreDamaged) {
  EXPECT_EQ(Read(23), Verdict::kDamaged);
  EXPECT_EQ(reader_.why(), "its data are not as long as width, height and steps say");
  EXPECT_EQ(Read(24), Verdict::kBuffer);
}

TEST_F(CloudMessages, BecomeWhatDownstreamTakesOrAreRefused) {
  wanted_.reset(gst_caps_from_string(
      "application/x-pointcloud2,point-step=16,fields=(string)\"x:F32:0,z:F32:8\""));
  ASSERT_EQ(Read(), Verdict::kBuffer);
  EXPECT_EQ(NewField("point-step"), "16");
  const BufferPtr buffer = reader_.TakeBuffer();
  EXPECT_EQ(gst_buffer_get_size(buffer.get()), 32U);
  wanted_.reset(gst_caps_from_string("application/x-pointcloud2,width=9"));
  reader_.Renegotiate();
  EXPECT_EQ(Read(), Verdict::kNotNegotiated);
  EXPECT_EQ(reader_.why(), "downstream takes other caps");
}

TEST(ImuSamples, HaveTimeAccelerationsAndTurnRatesInTheirOrder) {
  cdr::Imu imu;
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

TEST(Poses, HavePositionOrientationAndThatTheyAreTracked) {
  cdr::Odometry o;
  o.position = {1, 2, 3};
  o.orientation = {0, 0, 0.6, 0.8};
  Bytes expected;
  ByteWriter w(&expected);
  for (const double v : {1., 2., 3., 0., 0., 0.6, 0.8}) w.LeF64(v);
  w.Le64(GST_LIDAR_TRACKING_OK);
  EXPECT_EQ(WritePose(o), expected);
  const auto back = ReadPose(View(expected));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->position, o.position);
  EXPECT_EQ(back->orientation, o.orientation);
  expected.push_back(0);
  EXPECT_FALSE(ReadPose(View(expected)));
}

}  // namespace
}  // namespace lidar::gst
