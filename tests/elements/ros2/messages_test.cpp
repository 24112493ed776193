// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of conversions between buffers and messages, without a network.
#include <gtest/gtest.h>

#include "ext/ros2/message_reader.h"
#include "gst/common/buffer_map.h"
#include "gst/common/pose_covariance.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"

namespace lidar::gst {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Verdict = MessageReader::Verdict;

ByteView AsView(const Bytes& bytes) { return {bytes.data(), bytes.size()}; }

class CloudMessages : public ::testing::Test {
 protected:
  CloudMessages() {
    cloud_.header = {Time{} + Duration{1'700'000'000'000'000'005}, "os"};
    cloud_.layout = {1, 2, {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}}, false, 12, 24};
    cloud_.is_dense = true;
  }
  Verdict Read(std::size_t size = 24) {
    const Bytes points(size, 1);
    cloud_.data = AsView(points);
    return reader_.Read(AsView(cdr::WritePointCloud2(cloud_)));
  }
  /// Returns the field `name` of the reader's new caps, or an empty string if it has no new caps.
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
                          ++asked_;
                          return CapsPtr(wanted_ ? gst_caps_ref(wanted_.get()) : nullptr);
                        }};
  int asked_ = 0;  // number of times that the reader asked for downstream's caps
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

TEST_F(CloudMessages, AskDownstreamOnlyWhereSomethingChanged) {
  ASSERT_EQ(Read(), Verdict::kBuffer);
  const int once = asked_;
  for (int i = 0; i < 3; ++i) ASSERT_EQ(Read(), Verdict::kBuffer);
  EXPECT_EQ(asked_, once);
  cloud_.header.frame_id = "other";
  cloud_.is_dense = false;
  for (int i = 0; i < 3; ++i) ASSERT_EQ(Read(), Verdict::kBuffer);
  EXPECT_EQ(asked_, 2 * once);
}

TEST_F(CloudMessages, AreAdaptedAnewAfterOnesThatWereRefused) {
  ASSERT_EQ(Read(), Verdict::kBuffer);
  wanted_.reset(gst_caps_from_string("application/x-pointcloud2,width=9"));
  cloud_.layout.width = 3;
  cloud_.layout.row_step = 36;
  EXPECT_EQ(Read(36), Verdict::kNotNegotiated);
  cloud_.layout.width = 2;
  cloud_.layout.row_step = 24;
  EXPECT_EQ(Read(), Verdict::kNotNegotiated);
}

TEST_F(CloudMessages, OfFieldsThatNobodyKnowsAreDamaged) {
  for (auto& field : cloud_.layout.fields) field.datatype = 99;
  EXPECT_EQ(Read(), Verdict::kDamaged);
  EXPECT_NE(reader_.why(), "");
}

TEST_F(CloudMessages, MayNameAFrameThatIsNoText) {
  cloud_.header.frame_id = "\xff";
  ASSERT_EQ(Read(), Verdict::kBuffer);
  EXPECT_TRUE(g_utf8_validate(NewField("frame-id").c_str(), -1, nullptr));
}

/// A cloud with the layout that a driver publishes.
struct Driver {
  const char* name;
  std::uint32_t width, height;
  std::vector<cdr::RosField> fields;  // the fields after x, y and z
  std::uint32_t point_step;
  bool is_dense;
  const char* caps;  // the fields as they are in caps
};
class DriverClouds : public ::testing::TestWithParam<Driver> {};

constexpr std::uint8_t kU8 = 2, kU16 = 4, kU32 = 6, kF32 = 7, kF64 = 8;

/// The cloud has two points. Each byte has a different value.
TEST_P(DriverClouds, KeepTheirFields) {
  const Driver& d = GetParam();
  cdr::PointCloud2 cloud;
  cloud.header = {Time{} + Duration{5}, "lidar"};
  cloud.layout.width = d.width;
  cloud.layout.height = d.height;
  cloud.layout.fields = {{"x", 0, kF32, 1}, {"y", 4, kF32, 1}, {"z", 8, kF32, 1}};
  cloud.layout.fields.insert(cloud.layout.fields.end(), d.fields.begin(), d.fields.end());
  cloud.layout.point_step = d.point_step;
  cloud.layout.row_step = d.width * d.point_step;
  cloud.is_dense = d.is_dense;
  Bytes points(std::size_t{d.width} * d.height * d.point_step);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = static_cast<std::uint8_t>(i);
  cloud.data = AsView(points);
  MessageReader reader(cdr::RosType::kPointCloud2, [] { return CapsPtr(); });
  ASSERT_EQ(reader.Read(AsView(cdr::WritePointCloud2(cloud))), Verdict::kBuffer);
  const CapsPtr caps = reader.TakeNewCaps();
  const auto info = CloudInfo::FromFrameCaps(caps.get());
  ASSERT_TRUE(info);
  EXPECT_EQ(info->fields.ToString(), d.caps);
  EXPECT_EQ(info->point_step, d.point_step);
  EXPECT_EQ(info->height, d.height);
  const BufferPtr buffer = reader.TakeBuffer();
  const BufferMap map(buffer.get(), GST_MAP_READ);
  EXPECT_EQ(Bytes(map.view().begin(), map.view().end()), points);
}

constexpr const char* kRingAndTimestamp =
    "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,ring:U16:16,timestamp:F64:18";
INSTANTIATE_TEST_SUITE_P(
    Makers, DriverClouds,
    ::testing::Values(
        Driver{"Hesai",
               2,
               1,
               {{"intensity", 12, kF32, 1}, {"ring", 16, kU16, 1}, {"timestamp", 18, kF64, 1}},
               26,
               false,
               kRingAndTimestamp},
        Driver{"RoboSense",
               2,
               2,
               {{"intensity", 12, kF32, 1}, {"ring", 16, kU16, 1}, {"timestamp", 18, kF64, 1}},
               26,
               false,
               kRingAndTimestamp},
        Driver{"Velodyne",
               2,
               1,
               {{"intensity", 12, kF32, 1}, {"ring", 16, kU16, 1}, {"time", 18, kF32, 1}},
               22,
               true,
               "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,ring:U16:16,time:F32:18"},
        Driver{"Livox",
               2,
               1,
               {{"intensity", 12, kF32, 1},
                {"tag", 16, kU8, 1},
                {"line", 17, kU8, 1},
                {"timestamp", 18, kF64, 1}},
               26,
               true,
               "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,tag:U8:16,line:U8:17,timestamp:F64:18"},
        Driver{"Nebula",
               2,
               1,
               {{"intensity", 12, kU8, 1},
                {"return_type", 13, kU8, 1},
                {"channel", 14, kU16, 1},
                {"azimuth", 16, kF32, 1},
                {"elevation", 20, kF32, 1},
                {"distance", 24, kF32, 1},
                {"time_stamp", 28, kU32, 1}},
               32,
               true,
               "x:F32:0,y:F32:4,z:F32:8,intensity:U8:12,return_type:U8:13,channel:U16:14,"
               "azimuth:F32:16,elevation:F32:20,distance:F32:24,time_stamp:U32:28"},
        Driver{"Ouster",
               2,
               2,
               {{"intensity", 16, kF32, 1},
                {"t", 20, kU32, 1},
                {"reflectivity", 24, kU16, 1},
                {"ring", 26, kU16, 1},
                {"ambient", 28, kU16, 1},
                {"range", 32, kU32, 1}},
               48,
               true,
               "x:F32:0,y:F32:4,z:F32:8,intensity:F32:16,t:U32:20,reflectivity:U16:24,"
               "ring:U16:26,ambient:U16:28,range:U32:32"}),
    [](const auto& made) { return made.param.name; });

/// The buffer that was made from a message, and its caps as text.
struct Taken {
  BufferPtr buffer;
  std::string caps;
};
Taken Take(cdr::RosType type, const Bytes& message) {
  MessageReader reader(type, [] { return CapsPtr(); });
  if (reader.Read(AsView(message)) != Verdict::kBuffer) return {};
  const CapsPtr caps = reader.TakeNewCaps();
  const StringPtr text(gst_caps_to_string(caps.get()));
  return {reader.TakeBuffer(), text.get()};
}

TEST(MotionMessages, HaveTheirStampsAndFrames) {
  const cdr::Header header{Time{} + Duration{42}, "here"};
  cdr::Imu imu;
  imu.header = header;
  const Taken sample = Take(cdr::RosType::kImu, cdr::WriteImu(imu));
  ASSERT_TRUE(sample.buffer);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(sample.buffer.get()), 42U);
  EXPECT_NE(sample.caps.find("frame-id=(string)here"), std::string::npos);
  cdr::Odometry odometry;
  odometry.header = header;
  odometry.child_frame_id = "there";
  odometry.pose_covariance = CovarianceOf(GST_LIDAR_TRACKING_DEGENERATE);
  const Taken pose = Take(cdr::RosType::kOdometry, cdr::WriteOdometry(odometry));
  ASSERT_TRUE(pose.buffer);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(pose.buffer.get()), 42U);
  EXPECT_NE(pose.caps.find(" frame-id=(string)here"), std::string::npos);
  EXPECT_NE(pose.caps.find("child-frame-id=(string)there"), std::string::npos);
  guint8 tracking = 0;
  gst_buffer_extract(pose.buffer.get(), 56, &tracking, 1);
  EXPECT_EQ(tracking, GST_LIDAR_TRACKING_DEGENERATE);
  cdr::TransformStamped first, second;
  first.header = header;
  second.header.stamp = Time{} + Duration{43};
  const Taken transforms = Take(cdr::RosType::kTransforms, cdr::WriteTransforms({first, second}));
  ASSERT_TRUE(transforms.buffer);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(transforms.buffer.get()), 42U);
}

TEST(MotionMessages, HaveNewCapsOnlyWhereTheirFrameChanges) {
  MessageReader reader(cdr::RosType::kImu, [] { return CapsPtr(); });
  cdr::Imu imu;
  for (const char* frame : {"a", "a", "b", "b", "a"}) {
    const bool changes = imu.header.frame_id != frame;
    imu.header.frame_id = frame;
    const Bytes message = cdr::WriteImu(imu);
    ASSERT_EQ(reader.Read(AsView(message)), Verdict::kBuffer);
    EXPECT_EQ(reader.TakeNewCaps() != nullptr, changes) << frame;
  }
}

TEST(MotionMessages, MayNameAFrameThatIsNoText) {
  cdr::Imu imu;
  cdr::Odometry odometry;
  imu.header.frame_id = odometry.header.frame_id = "\xff";
  for (const auto& [type, message] :
       {std::pair(cdr::RosType::kImu, cdr::WriteImu(imu)),
        std::pair(cdr::RosType::kOdometry, cdr::WriteOdometry(odometry))}) {
    MessageReader reader(type, [] { return CapsPtr(); });
    ASSERT_EQ(reader.Read(AsView(message)), Verdict::kBuffer);
    const CapsPtr caps = reader.TakeNewCaps();
    const char* frame = gst_structure_get_string(gst_caps_get_structure(caps.get(), 0), "frame-id");
    ASSERT_NE(frame, nullptr);
    EXPECT_TRUE(g_utf8_validate(frame, -1, nullptr));
  }
}

TEST(MotionMessages, ThatAreCutAreDamagedAndSayWhatTheyAreNot) {
  const auto why = [](cdr::RosType type, Bytes message) {
    message.resize(message.size() / 2);
    MessageReader reader(type, [] { return CapsPtr(); });
    EXPECT_EQ(reader.Read(AsView(message)), Verdict::kDamaged);
    return reader.why();
  };
  EXPECT_EQ(why(cdr::RosType::kImu, cdr::WriteImu({})),
            "the message is truncated or is not an Imu");
  EXPECT_EQ(why(cdr::RosType::kOdometry, cdr::WriteOdometry({})),
            "the message is truncated or is not an Odometry");
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
  EXPECT_EQ(reader_.why(), "the length of its data does not match width, height and steps");
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
  EXPECT_EQ(reader_.why(), "the next element does not accept these caps");
}

TEST(TransformMessages, AreDamagedWhereTheyAreCutAndEmptyWhereTheySayNothing) {
  MessageReader reader(
      cdr::RosType::kTransforms, [] { return CapsPtr(); }, true);
  Bytes message = cdr::WriteTransforms({cdr::TransformStamped{}});
  EXPECT_EQ(reader.Read(AsView(message)), Verdict::kBuffer);
  message.pop_back();
  EXPECT_EQ(reader.Read(AsView(message)), Verdict::kDamaged);
  EXPECT_EQ(reader.why(), "the message is truncated or is not a TFMessage");
  EXPECT_EQ(reader.Read(AsView(cdr::WriteTransforms({}))), Verdict::kEmpty);
}

TEST(Covariances, OfPosesThatAreNotTrackedAreLarge) {
  for (const GstLidarTracking tracking :
       {GST_LIDAR_TRACKING_OK, GST_LIDAR_TRACKING_DEGENERATE, GST_LIDAR_TRACKING_LOST})
    EXPECT_EQ(TrackingOf(CovarianceOf(tracking)), tracking);
  EXPECT_EQ(CovarianceOf(GST_LIDAR_TRACKING_STARTED), Covariance{});
  EXPECT_EQ(CovarianceOf(GST_LIDAR_TRACKING_LOST)[35], 1e6);
  EXPECT_EQ(CovarianceOf(77)[35], 1e6);
  EXPECT_EQ(CovarianceOf(GST_LIDAR_TRACKING_DEGENERATE)[0], 1e3);
}

}  // namespace
}  // namespace lidar::gst
