// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of messages that are made from buffers and of DDS settings that are made from properties,
// without a network.
#include <gtest/gtest.h>

#include <cstdlib>

#include "ext/ros2/message_writer.h"
#include "ext/ros2/ros_settings.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/motion_samples.h"

namespace lidar::gst {
namespace {

using Message = std::vector<std::uint8_t>;

constexpr const char* kCloud =
    "application/x-pointcloud2,width=2,height=1,point-step=12,is-dense=true,"
    "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\"";

ByteView Whole(const Message& bytes) { return {bytes.data(), bytes.size()}; }

GstBuffer* Zeros(gsize size) {
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, size, nullptr);
  gst_buffer_memset(buffer, 0, 0, size);
  return buffer;
}

class WrittenMessages : public ::testing::Test {
 protected:
  std::unique_ptr<MessageWriter> Make(cdr::RosType type, const std::string& text) {
    const CapsPtr caps(gst_caps_from_string(text.c_str()));
    return MessageWriter::Make(type, caps.get(), &why_);
  }
  bool Write(MessageWriter* writer, GstBuffer* buffer) {
    const BufferPtr owner(buffer);
    messages_.clear();
    return writer->Write(buffer, settings_, now_, [this](const std::vector<ByteView>& pieces) {
      Message all;
      for (const ByteView& piece : pieces) all.insert(all.end(), piece.begin(), piece.end());
      messages_.push_back(all);
    });
  }
  cdr::Odometry WritePose(MessageWriter* writer, GstLidarTracking tracking) {
    GstBuffer* pose = Zeros(64);
    const guint8 byte = tracking;
    gst_buffer_fill(pose, 56, &byte, 1);
    EXPECT_TRUE(Write(writer, pose));
    return cdr::ReadOdometry(Whole(messages_.at(0))).value_or(cdr::Odometry());
  }

  std::string why_;
  MessageSettings settings_;
  Time now_ = Time{} + Duration{77};
  std::vector<Message> messages_;
};

TEST_F(WrittenMessages, HaveTheTypeThatTheirCapsUsuallyBecome) {
  const auto usual = [](const char* text) {
    const CapsPtr caps(gst_caps_from_string(text));
    return MessageWriter::UsualType(caps.get());
  };
  EXPECT_EQ(usual("application/x-pointcloud2"), cdr::RosType::kPointCloud2);
  EXPECT_EQ(usual("application/x-imu"), cdr::RosType::kImu);
  EXPECT_EQ(usual("application/x-odometry"), cdr::RosType::kOdometry);
  EXPECT_EQ(usual("video/x-raw"), std::nullopt);
}

TEST_F(WrittenMessages, OfAnImuNeedTheFieldsThatWeKnowOrNone) {
  const auto imu = cdr::RosType::kImu;
  EXPECT_TRUE(Make(imu, "application/x-imu"));
  EXPECT_TRUE(Make(imu, std::string("application/x-imu,fields=(string)\"") + kImuFields + "\""));
  EXPECT_FALSE(Make(imu, "application/x-imu,fields=(string)\"t:U64:0\""));
  EXPECT_NE(why_.find("fields"), std::string::npos) << why_;
}

TEST_F(WrittenMessages, OfAnImuHaveTheTimesOfTheirSamples) {
  const auto writer = Make(cdr::RosType::kImu, "application/x-imu");
  ASSERT_TRUE(writer);
  GstBuffer* samples = Zeros(64);
  const guint8 time = 5;
  gst_buffer_fill(samples, 32, &time, 1);
  gst_lidar_buffer_set_capture_time(samples, 1'000);
  ASSERT_TRUE(Write(writer.get(), samples));
  ASSERT_EQ(messages_.size(), 2U);
  const auto second = cdr::ReadImu(Whole(messages_[1]));
  ASSERT_TRUE(second);
  EXPECT_EQ(second->header.stamp, Time{} + Duration{5});
  EXPECT_EQ(second->header.frame_id, "imu");
  EXPECT_FALSE(Write(writer.get(), gst_buffer_new()));
}

TEST_F(WrittenMessages, HaveTheTimeOfTheirBufferOrThePresent) {
  const auto writer = Make(cdr::RosType::kPointCloud2, kCloud);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(Write(writer.get(), Zeros(24)));
  EXPECT_EQ(cdr::ReadPointCloud2(Whole(messages_[0]))->header.stamp, now_);
  GstBuffer* timed = Zeros(24);
  gst_lidar_buffer_set_capture_time(timed, 55);
  ASSERT_TRUE(Write(writer.get(), timed));
  const auto cloud = cdr::ReadPointCloud2(Whole(messages_[0]));
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->header.stamp, Time{} + Duration{55});
  EXPECT_EQ(cloud->header.frame_id, "lidar");
  EXPECT_TRUE(cloud->is_dense);
}

TEST_F(WrittenMessages, OfCloudsAreAsLargeAsTheirCapsSayOfOneRowAnySize) {
  const auto written = [&](const std::string& caps, gsize size) {
    const auto writer = Make(cdr::RosType::kPointCloud2, caps);
    return writer && Write(writer.get(), Zeros(size));
  };
  const std::string row =
      "application/x-pointcloud2,width=2,height=1,point-step=12,"
      "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\"";
  EXPECT_TRUE(written(row, 36));
  const auto cloud = cdr::ReadPointCloud2(Whole(messages_[0]));
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->layout.width, 3U);
  EXPECT_EQ(cloud->layout.row_step, 36U);
  for (const gsize size : {13U, 25U, 30U, 35U}) EXPECT_FALSE(written(row, size)) << size;
  const std::string rows =
      "application/x-pointcloud2,width=2,height=2,point-step=12,"
      "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\"";
  EXPECT_TRUE(written(rows, 48));
  for (const gsize size : {24U, 49U, 72U}) EXPECT_FALSE(written(rows, size)) << size;
  // If the caps have no width, the width follows from the size of the buffer.
  const std::string open =
      "application/x-pointcloud2,height=2,point-step=12,"
      "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\"";
  EXPECT_TRUE(written(open, 72));
  EXPECT_EQ(cdr::ReadPointCloud2(Whole(messages_[0]))->layout.width, 3U);
  EXPECT_FALSE(written(open, 25));
}

TEST_F(WrittenMessages, AreNotMadeOfCapsOrBuffersThatCannotBe) {
  for (const char* caps :
       {"width=2,height=1,point-step=12",
        "width=2,height=1,point-step=8,fields=(string)\"x:F32:0,y:F32:4,z:F32:8\"",
        "width=2,height=0,point-step=12,fields=(string)\"x:F32:0\""}) {
    why_.clear();
    EXPECT_FALSE(Make(cdr::RosType::kPointCloud2, std::string("application/x-pointcloud2,") + caps))
        << caps;
    EXPECT_FALSE(why_.empty()) << caps;
  }
  for (const auto type : {cdr::RosType::kOdometry, cdr::RosType::kTransforms}) {
    const auto writer = Make(type, "application/x-odometry");
    ASSERT_TRUE(writer);
    for (const gsize size : {0U, 63U, 65U}) {
      EXPECT_FALSE(Write(writer.get(), Zeros(size))) << size;
      EXPECT_TRUE(messages_.empty()) << size;
    }
  }
}

TEST_F(WrittenMessages, OfOdometryNameFramesBySettingElseByCapsElseAsUsual) {
  const auto writer = Make(cdr::RosType::kOdometry, "application/x-odometry");
  ASSERT_TRUE(writer);
  auto pose = WritePose(writer.get(), GST_LIDAR_TRACKING_OK);
  EXPECT_EQ(pose.header.frame_id, "odom");
  EXPECT_EQ(pose.child_frame_id, "lidar");
  const auto named =
      Make(cdr::RosType::kOdometry, "application/x-odometry,frame-id=map,child-frame-id=base");
  ASSERT_TRUE(named);
  pose = WritePose(named.get(), GST_LIDAR_TRACKING_OK);
  EXPECT_EQ(pose.header.frame_id, "map");
  EXPECT_EQ(pose.child_frame_id, "base");
  settings_.frames = {"earth", "os"};
  pose = WritePose(named.get(), GST_LIDAR_TRACKING_OK);
  EXPECT_EQ(pose.header.frame_id, "earth");
  EXPECT_EQ(pose.child_frame_id, "os");
}

TEST_F(WrittenMessages, OfTransformsHaveNoPoseThatIsLost) {
  const auto writer = Make(cdr::RosType::kTransforms, "application/x-odometry");
  for (const guint8 tracking : {GST_LIDAR_TRACKING_STARTED, GST_LIDAR_TRACKING_OK,
                                GST_LIDAR_TRACKING_DEGENERATE, GST_LIDAR_TRACKING_LOST}) {
    GstBuffer* pose = Zeros(64);
    gst_buffer_fill(pose, 56, &tracking, 1);
    EXPECT_TRUE(Write(writer.get(), pose));
    EXPECT_EQ(messages_.size(), tracking == GST_LIDAR_TRACKING_LOST ? 0U : 1U) << int{tracking};
  }
}

TEST_F(WrittenMessages, OfPosesHaveTheVarianceOfTheSettingsWhereTheyAreTracked) {
  const auto writer = Make(cdr::RosType::kOdometry, "application/x-odometry");
  ASSERT_TRUE(writer);
  settings_.position_variance = 0.25;
  settings_.orientation_variance = 0.5;
  for (const auto tracking : {GST_LIDAR_TRACKING_STARTED, GST_LIDAR_TRACKING_OK}) {
    const auto pose = WritePose(writer.get(), tracking);
    EXPECT_EQ(pose.pose_covariance[0], 0.25);
    EXPECT_EQ(pose.pose_covariance[35], 0.5);
    EXPECT_EQ(pose.twist_covariance[0], 1e6);
  }
  EXPECT_EQ(WritePose(writer.get(), GST_LIDAR_TRACKING_DEGENERATE).pose_covariance[0], 1e3);
  EXPECT_EQ(WritePose(writer.get(), GST_LIDAR_TRACKING_LOST).pose_covariance[35], 1e6);
  settings_.position_variance = 0;
  auto pose = WritePose(writer.get(), GST_LIDAR_TRACKING_OK);
  EXPECT_EQ(pose.pose_covariance[0], 0) << "it is not known";
  EXPECT_EQ(pose.pose_covariance[35], 0.5);
  settings_.position_variance = 0.25;
  settings_.orientation_variance = 0;
  pose = WritePose(writer.get(), GST_LIDAR_TRACKING_OK);
  EXPECT_EQ(pose.pose_covariance[0], 0.25);
  EXPECT_EQ(pose.pose_covariance[35], 0) << "it is not known";
  GstBuffer* measured = Zeros(64 + 36 * sizeof(double));
  const double correlation = 3;
  gst_buffer_fill(measured, 64 + sizeof(double), &correlation, sizeof correlation);
  ASSERT_TRUE(Write(writer.get(), measured));
  const auto set = cdr::ReadOdometry(Whole(messages_.at(0)));
  ASSERT_TRUE(set);
  EXPECT_EQ(set->pose_covariance[0], 0.25);
  EXPECT_EQ(set->pose_covariance[1], 0) << "the setting replaces what the pose came with";
}

class RosOptions : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* domain = std::getenv("ROS_DOMAIN_ID");
    before_ = domain != nullptr ? domain : "";
    gst_object_ref_sink(element_.get());
  }
  void TearDown() override { g_setenv("ROS_DOMAIN_ID", before_.c_str(), TRUE); }
  std::optional<dds::EndpointOptions> Options() {
    return ToOptions(element_.get(), settings_, cdr::RosType::kImu);
  }
  /// Returns the domain if ROS_DOMAIN_ID has the value `variable`, or -1 if this is an error.
  int DomainOf(const char* variable) {
    g_setenv("ROS_DOMAIN_ID", variable, TRUE);
    const auto options = Options();
    return options ? static_cast<int>(options->domain) : -1;
  }

  ElementPtr element_{gst_element_factory_make("fakesink", "my-sink")};
  RosSettings settings_;
  std::string before_;
};

TEST_F(RosOptions, TakeTheDomainOfTheVariableWhereNobodySaysOtherwise) {
  EXPECT_EQ(DomainOf(""), 0);
  EXPECT_EQ(DomainOf("7"), 7);
  EXPECT_EQ(DomainOf("232"), 232);
  for (const char* bad : {"233", "-1", "7x", "x"}) EXPECT_EQ(DomainOf(bad), -1) << bad;
  g_unsetenv("ROS_DOMAIN_ID");
  EXPECT_EQ(Options()->domain, 0U);
  settings_.domain_id = 0;
  EXPECT_EQ(DomainOf("7"), 0);
  EXPECT_EQ(DomainOf("x"), 0);  // the property is set, so the variable is ignored
  settings_.domain_id = 9;
  EXPECT_EQ(DomainOf("7"), 9);
}

TEST_F(RosOptions, AreWhatTheSettingsSay) {
  settings_.depth = 8;
  settings_.topic = "/imu";
  auto options = Options();
  ASSERT_TRUE(options);
  EXPECT_EQ(options->topic, "rt/imu");
  EXPECT_EQ(options->type, cdr::RosType::kImu);
  EXPECT_EQ(options->node.name, "my_sink");
  EXPECT_EQ(options->depth, 8U);
  EXPECT_FALSE(options->reliable);
  EXPECT_FALSE(options->transient);
  EXPECT_EQ(options->gid_size, 16U);
  EXPECT_TRUE(options->tells_type_hash);
  settings_.qos = RosQos::kReliable;
  settings_.distro = RosDistro::kHumble;
  settings_.node_name = "/robot/edge";
  options = Options();
  ASSERT_TRUE(options);
  EXPECT_TRUE(options->reliable);
  EXPECT_EQ(options->gid_size, 24U);
  EXPECT_FALSE(options->tells_type_hash);
  EXPECT_EQ(options->node.name_space, "/robot");
  EXPECT_EQ(options->node.name, "edge");
}

}  // namespace
}  // namespace lidar::gst
