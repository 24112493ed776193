// SPDX-License-Identifier: LGPL-2.1-or-later
#include <thread>
#include <utility>

#include "src/cdr/messages.h"
#include "tests/elements/ros2/ros2_support.h"

namespace lidar::test {
namespace {

using gst::CapsPtr;
using Qos = FastPeer::Qos;

/// A fixture with a ros2sink and a Fast DDS subscriber that matches it.
class Ros2Sink : public Ros2Test {
 protected:
  template <class Message>
  void StartWithPeer(const std::string& type, const std::string& properties, CapsPtr caps) {
    Start("ros2sink", "topic=/points sync=false " + properties);
    gst_harness_set_src_caps(h_.get(), caps.release());
    peer_ = std::make_unique<FastPeer>(TestDomain());
    peer_->Subscribe<Message>("rt/points", type, Qos::kReliable);
    ASSERT_TRUE(peer_->WaitForMatch(kPatience));
    ASSERT_TRUE(WaitForStat("subscribers", 1));
  }
  void StartWithCloudPeer(const PeerCloud& cloud, const std::string& properties = "",
                          const char* more_caps = "") {
    StartWithPeer<PeerCloud>(kCloudType, properties, CloudCaps(cloud, more_caps));
  }
  /// Pushes the cloud again and again until a warning or an error is posted. Returns its text.
  std::string PushUntilComplaint(const PeerCloud& cloud) {
    std::string text;
    EXPECT_TRUE(Eventually([&] {
      EXPECT_EQ(gst_harness_push(h_.get(), CloudBuffer(cloud)), GST_FLOW_OK);
      text = NextComplaint(50 * GST_MSECOND);
      return !text.empty();
    }));
    return text;
  }
  PeerCloud Taken() {
    PeerCloud cloud;
    EXPECT_TRUE(peer_->Take(&cloud, kPatience));
    return cloud;
  }

  std::unique_ptr<FastPeer> peer_;
};

TEST_F(Ros2Sink, PublishesCloudsThatFastDdsUnderstands) {
  const PeerCloud cloud = TestCloud(64, 16);
  StartWithCloudPeer(cloud);
  ASSERT_EQ(gst_harness_push(h_.get(), CloudBuffer(cloud)), GST_FLOW_OK);
  const PeerCloud taken = Taken();
  EXPECT_EQ(taken.header.sec, cloud.header.sec);
  EXPECT_EQ(taken.header.nanosec, cloud.header.nanosec);
  EXPECT_EQ(taken.header.frame_id, "lidar");
  EXPECT_EQ(taken.height, 16u);
  EXPECT_EQ(taken.width, 64u);
  EXPECT_EQ(taken.point_step, 24u);
  EXPECT_EQ(taken.row_step, 24u * 64);
  EXPECT_FALSE(taken.is_bigendian);
  EXPECT_FALSE(taken.is_dense);
  EXPECT_EQ(taken.data, cloud.data);
  ASSERT_EQ(taken.fields.size(), cloud.fields.size());
  for (std::size_t i = 0; i < taken.fields.size(); ++i) {
    EXPECT_EQ(taken.fields[i].name, cloud.fields[i].name);
    EXPECT_EQ(taken.fields[i].offset, cloud.fields[i].offset);
    EXPECT_EQ(taken.fields[i].datatype, cloud.fields[i].datatype);
    EXPECT_EQ(taken.fields[i].count, 1u);
  }
  EXPECT_EQ(Stat("messages"), 1u);
}

TEST_F(Ros2Sink, TakesTheFrameFromItsPropertyOrElseFromTheCaps) {
  const PeerCloud cloud = TestCloud(2, 1);
  StartWithCloudPeer(cloud, "", ",frame-id=os_lidar");
  ASSERT_EQ(gst_harness_push(h_.get(), CloudBuffer(cloud)), GST_FLOW_OK);
  EXPECT_EQ(Taken().header.frame_id, "os_lidar");
  g_object_set(ros_.get(), "frame-id", "front", nullptr);
  ASSERT_EQ(gst_harness_push(h_.get(), CloudBuffer(cloud)), GST_FLOW_OK);
  EXPECT_EQ(Taken().header.frame_id, "front");
}

TEST_F(Ros2Sink, GivesBuffersWithoutCaptureTimeThePresent) {
  const PeerCloud cloud = TestCloud(2, 1);
  StartWithCloudPeer(cloud);
  const gint64 before = g_get_real_time() / G_USEC_PER_SEC;
  ASSERT_EQ(gst_harness_push(h_.get(), gst_buffer_new_memdup(cloud.data.data(), 48)), GST_FLOW_OK);
  EXPECT_GE(Taken().header.sec, before);
}

TEST_F(Ros2Sink, FollowsTheCaps) {
  StartWithCloudPeer(TestCloud(2, 1));
  ASSERT_EQ(gst_harness_push(h_.get(), CloudBuffer(TestCloud(2, 1))), GST_FLOW_OK);
  EXPECT_EQ(Taken().width, 2u);
  gst_harness_set_src_caps(h_.get(), CloudCaps(TestCloud(5, 3)).release());
  ASSERT_EQ(gst_harness_push(h_.get(), CloudBuffer(TestCloud(5, 3))), GST_FLOW_OK);
  const PeerCloud taken = Taken();
  EXPECT_EQ(taken.width, 5u);
  EXPECT_EQ(taken.height, 3u);
}

TEST_F(Ros2Sink, DropsAndCountsBuffersThatAreNotAsTheirCapsSay) {
  const PeerCloud cloud = TestCloud(2, 2);
  StartWithCloudPeer(cloud);
  for (const gsize size : {0u, 95u, 48u, 192u})
    ASSERT_EQ(gst_harness_push(h_.get(), gst_buffer_new_allocate(nullptr, size, nullptr)),
              GST_FLOW_OK);
  EXPECT_EQ(Stat("buffers-refused"), 4u);
  EXPECT_NE(NextComplaint().find("does not match its caps"), std::string::npos);
  EXPECT_EQ(NextComplaint(0), "");  // one warning for all
  ASSERT_EQ(gst_harness_push(h_.get(), CloudBuffer(cloud)), GST_FLOW_OK);
  EXPECT_EQ(Taken().data, cloud.data);
}

TEST_F(Ros2Sink, CostsLittleWhereNobodyListens) {
  Start("ros2sink", "topic=/points sync=false");
  const PeerCloud cloud = TestCloud(2, 1);
  gst_harness_set_src_caps(h_.get(), CloudCaps(cloud).release());
  ASSERT_EQ(gst_harness_push(h_.get(), CloudBuffer(cloud)), GST_FLOW_OK);
  EXPECT_EQ(Stat("messages-without-subscriber"), 1u);
  EXPECT_EQ(Stat("messages"), 0u);
  gst_element_set_state(h_->element, GST_STATE_NULL);
  gst_element_set_state(h_->element, GST_STATE_PLAYING);
  EXPECT_EQ(Stat("messages-without-subscriber"), 0u);
}

TEST_F(Ros2Sink, SendsNothingOnceItsSubscriberIsGone) {
  const PeerCloud cloud = TestCloud(2, 1);
  StartWithCloudPeer(cloud);
  peer_.reset();
  ASSERT_TRUE(WaitForNone("subscribers"));
  ASSERT_EQ(gst_harness_push(h_.get(), CloudBuffer(cloud)), GST_FLOW_OK);
  EXPECT_EQ(Stat("messages"), 0u);
  EXPECT_EQ(Stat("messages-without-subscriber"), 1u);
}

TEST_F(Ros2Sink, TellsOfSubscribersThatItsReliabilityDoesNotFit) {
  Start("ros2sink", "topic=/points sync=false qos=sensor-data");
  const PeerCloud cloud = TestCloud(2, 1);
  gst_harness_set_src_caps(h_.get(), CloudCaps(cloud).release());
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Subscribe<PeerCloud>("rt/points", kCloudType, Qos::kReliable);
  EXPECT_NE(PushUntilComplaint(cloud).find("qos=sensor-data"), std::string::npos);
  ASSERT_EQ(gst_harness_push(h_.get(), CloudBuffer(cloud)), GST_FLOW_OK);
  EXPECT_EQ(NextComplaint(0), "");  // there is only one warning per subscriber
}

TEST_F(Ros2Sink, TellsInEachRunOfWhatDoesNotFit) {
  const PeerCloud cloud = TestCloud(2, 1);
  const gst::StringPtr caps(gst_caps_to_string(CloudCaps(cloud).get()));
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Subscribe<PeerCloud>("rt/points", kCloudType, Qos::kReliable);
  Start("ros2sink", "topic=/points sync=false qos=sensor-data");
  for (int run = 0; run < 2; ++run) {
    StartAgain(caps.get());
    EXPECT_NE(PushUntilComplaint(cloud).find("qos=sensor-data"), std::string::npos) << run;
  }
}

TEST_F(Ros2Sink, TellsInEachRunOfBuffersThatAreNotAsTheirCapsSay) {
  const PeerCloud cloud = TestCloud(2, 1);
  const gst::StringPtr caps(gst_caps_to_string(CloudCaps(cloud).get()));
  StartWithCloudPeer(cloud);
  for (int run = 0; run < 2; ++run) {
    gst_harness_push(h_.get(), gst_buffer_new_allocate(nullptr, 47, nullptr));
    EXPECT_NE(NextComplaint().find("does not match its caps"), std::string::npos) << run;
    EXPECT_EQ(Stat("buffers-refused"), 1U) << run;
    StartAgain(caps.get());
    ASSERT_TRUE(WaitForStat("subscribers", 1));
  }
}

TEST_F(Ros2Sink, BlamesNoReliabilityForSubscribersThatWantEarlierMessages) {
  Start("ros2sink", "topic=/points sync=false qos=reliable");
  const PeerCloud cloud = TestCloud(2, 1);
  gst_harness_set_src_caps(h_.get(), CloudCaps(cloud).release());
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Subscribe<PeerCloud>("rt/points", kCloudType, Qos::kReliableTransient);
  const std::string text = PushUntilComplaint(cloud);
  EXPECT_NE(text.find("transient local"), std::string::npos) << text;
  EXPECT_EQ(text.find("qos="), std::string::npos) << text;
}

TEST_F(Ros2Sink, RefusesACloudOfOneRowThatEndsWithinAPoint) {
  const PeerCloud cloud = TestCloud(2, 1);
  StartWithCloudPeer(cloud);
  for (const gsize size : {25u, 72u})  // a row may have any number of points
    ASSERT_EQ(gst_harness_push(h_.get(), gst_buffer_new_allocate(nullptr, size, nullptr)),
              GST_FLOW_OK);
  EXPECT_EQ(Stat("buffers-refused"), 1u);
  EXPECT_EQ(Taken().width, 3u);
}

TEST_F(Ros2Sink, TakesAnotherTypeWithTheCaps) {
  Start("ros2sink", "topic=/points sync=false");
  gst_harness_set_src_caps(h_.get(), CloudCaps(TestCloud(2, 1)).release());
  ASSERT_EQ(gst_harness_push(h_.get(), CloudBuffer(TestCloud(2, 1))), GST_FLOW_OK);
  gst_harness_set_src_caps_str(h_.get(), "application/x-imu,sample-size=32");
  ASSERT_EQ(gst_harness_push(h_.get(), gst_buffer_new_allocate(nullptr, 64, nullptr)), GST_FLOW_OK);
  EXPECT_EQ(Stat("messages-without-subscriber"), 3u) << "a message for each of the two samples";
}

TEST_F(Ros2Sink, RefusesSamplesOfOtherFields) {
  Start("ros2sink", "topic=/imu");
  gst_harness_set_src_caps_str(h_.get(), "application/x-imu,sample-size=8,fields=(string)t:U64:0");
  gst_harness_push(h_.get(), gst_buffer_new_allocate(nullptr, 32, nullptr));
  EXPECT_NE(NextComplaint().find("the fields of IMU samples must be t:U64:0,ax:F32:8"),
            std::string::npos);
}

TEST_F(Ros2Sink, PublishesEachSampleOfAnImu) {
  StartWithPeer<PeerImu>("sensor_msgs::msg::dds_::Imu_", "",
                         CapsPtr(gst_caps_from_string("application/x-imu,sample-size=32")));
  std::vector<std::uint8_t> samples(64);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::uint64_t t = 3'000'000'000 + i;
    const float values[6] = {0.5f, 0, 9.75f, 1, 2, 3};
    std::memcpy(samples.data() + 32 * i, &t, 8);
    std::memcpy(samples.data() + 32 * i + 8, values, sizeof values);
  }
  ASSERT_EQ(gst_harness_push(h_.get(), gst_buffer_new_memdup(samples.data(), samples.size())),
            GST_FLOW_OK);
  for (const std::uint32_t nanosec : {0u, 1u}) {
    PeerImu imu;
    ASSERT_TRUE(peer_->Take(&imu, kPatience));
    EXPECT_EQ(imu.header.sec, 3);
    EXPECT_EQ(imu.header.nanosec, nanosec);
    EXPECT_EQ(imu.header.frame_id, "imu");
    EXPECT_EQ(imu.orientation_covariance[0], -1);  // -1: the message has no orientation
    EXPECT_EQ(imu.linear_acceleration, (std::array<double, 3>{0.5, 0, 9.75}));
    EXPECT_EQ(imu.angular_velocity, (std::array<double, 3>{1, 2, 3}));
  }
}

constexpr double kPose[7] = {1, -2, 3, 0, 0, 0.6, 0.8};

GstBuffer* PoseBuffer(GstLidarTracking tracking = GST_LIDAR_TRACKING_OK) {
  std::uint8_t bytes[64] = {};
  std::memcpy(bytes, kPose, sizeof kPose);
  bytes[56] = static_cast<std::uint8_t>(tracking);
  GstBuffer* buffer = gst_buffer_new_memdup(bytes, sizeof bytes);
  gst_lidar_buffer_set_capture_time(buffer, 7 * GST_SECOND + 8);
  return buffer;
}

TEST_F(Ros2Sink, PublishesOdometry) {
  StartWithPeer<PeerOdometry>("nav_msgs::msg::dds_::Odometry_", "child-frame-id=base_link",
                              CapsPtr(gst_caps_from_string("application/x-odometry")));
  ASSERT_EQ(gst_harness_push(h_.get(), PoseBuffer()), GST_FLOW_OK);
  PeerOdometry odometry;
  ASSERT_TRUE(peer_->Take(&odometry, kPatience));
  EXPECT_EQ(odometry.header.sec, 7);
  EXPECT_EQ(odometry.header.frame_id, "odom");
  EXPECT_EQ(odometry.child_frame_id, "base_link");
  EXPECT_TRUE(std::equal(odometry.pose.begin(), odometry.pose.end(), std::begin(kPose)));
}

TEST_F(Ros2Sink, GivesTrackedPosesTheVarianceThatItIsTold) {
  StartWithPeer<PeerOdometry>("nav_msgs::msg::dds_::Odometry_",
                              "position-variance=0.01 orientation-variance=0.002",
                              CapsPtr(gst_caps_from_string("application/x-odometry")));
  for (const auto tracking : {GST_LIDAR_TRACKING_OK, GST_LIDAR_TRACKING_LOST}) {
    const bool tracked = tracking == GST_LIDAR_TRACKING_OK;
    // A message is lost if it is sent before the two endpoints match. Therefore the test repeats
    // it.
    PeerOdometry odometry;
    EXPECT_TRUE(Eventually([&] {
      EXPECT_EQ(gst_harness_push(h_.get(), PoseBuffer(tracking)), GST_FLOW_OK);
      peer_->Take(&odometry, std::chrono::milliseconds(100));
      return odometry.pose_covariance[7] == (tracked ? 0.01 : 1e6);
    }));
    EXPECT_EQ(odometry.pose_covariance[21], tracked ? 0.002 : 1e6);
    EXPECT_EQ(odometry.pose_covariance[1], 0);
    EXPECT_EQ(odometry.twist_covariance[0], 1e6);
  }
}

TEST_F(Ros2Sink, ItsTransformsAreThoseThatTheSourceTakes) {
  Start("ros2src", "topic=/tf type=tf qos=reliable");
  const std::string line =
      "ros2sink topic=/tf type=tf sync=false domain-id=" + std::to_string(TestDomain());
  const Harness sink(gst_harness_new_parse(line.c_str()));
  gst_harness_set_src_caps_str(sink.get(), "application/x-odometry,child-frame-id=base");
  ASSERT_TRUE(WaitForStat("publishers", 1));
  // A message is lost if it is sent before the two endpoints match. Therefore the test repeats it.
  ASSERT_TRUE(Eventually([&] {
    EXPECT_EQ(gst_harness_push(sink.get(), PoseBuffer()), GST_FLOW_OK);
    g_usleep(50'000);
    return Stat("messages") > 0;
  }));
  const gst::BufferPtr buffer = Pull();
  ASSERT_TRUE(buffer);
  const auto bytes = BytesOf(buffer.get());
  const auto transforms = cdr::ReadTransforms({bytes.data(), bytes.size()});
  ASSERT_TRUE(transforms);
  ASSERT_EQ(transforms->size(), 1u);
  EXPECT_EQ((*transforms)[0].child_frame_id, "base");
  EXPECT_EQ((*transforms)[0].rotation, (cdr::Quaternion{0, 0, 0.6, 0.8}));
}

TEST_F(Ros2Sink, PublishesTransforms) {
  StartWithPeer<PeerTransforms>("tf2_msgs::msg::dds_::TFMessage_", "type=tf",
                                CapsPtr(gst_caps_from_string("application/x-odometry")));
  ASSERT_EQ(gst_harness_push(h_.get(), PoseBuffer()), GST_FLOW_OK);
  PeerTransforms message;
  ASSERT_TRUE(peer_->Take(&message, kPatience));
  ASSERT_EQ(message.transforms.size(), 1u);
  const PeerTransform& transform = message.transforms[0];
  EXPECT_EQ(transform.header.sec, 7);
  EXPECT_EQ(transform.header.frame_id, "odom");
  EXPECT_EQ(transform.child_frame_id, "lidar");
  EXPECT_TRUE(std::equal(transform.transform.begin(), transform.transform.end(), kPose));
}

/// Returns the error of an element that fails to start.
std::string StartError(const std::string& line) {
  const std::unique_ptr<GstElement, gst::Unref> element(gst_parse_launch(line.c_str(), nullptr));
  const ElementBus bus(element.get());
  const bool fails =
      gst_element_set_state(element.get(), GST_STATE_PAUSED) == GST_STATE_CHANGE_FAILURE;
  gst_element_set_state(element.get(), GST_STATE_NULL);
  return fails ? bus.Text(GST_MESSAGE_ERROR) : "it starts";
}

TEST_F(Ros2Sink, FailsAtTheStartWhereItsTypeIsKnownAndItCannotPublish) {
  EXPECT_NE(
      StartError("ros2sink type=pointcloud2 topic=\"/a b\"").find("topic \"/a b\" is not valid"),
      std::string::npos);
  const std::string before = g_getenv("CYCLONEDDS_URI");
  g_setenv("CYCLONEDDS_URI", "<General><NoSuchThing>1</NoSuchThing></General>", TRUE);
  for (const auto& [element, work] :
       {std::pair("ros2sink type=pointcloud2 topic=/points", "publish"),
        std::pair("ros2src type=pointcloud2 topic=/points", "subscribe to")}) {
    const std::string text = StartError(std::string(element) + " domain-id=230");
    EXPECT_EQ(text.rfind("DDS cannot " + std::string(work) + " /points: ", 0), 0U) << text;
    EXPECT_NE(text.find("check the variable CYCLONEDDS_URI"), std::string::npos) << text;
  }
  g_setenv("CYCLONEDDS_URI", before.c_str(), TRUE);
}

TEST_F(Ros2Sink, RefusesCapsOfAnotherTypeThanAskedFor) {
  Start("ros2sink", "topic=/points type=imu");
  gst_harness_set_src_caps(h_.get(), CloudCaps(TestCloud(1, 1)).release());
  gst_harness_push(h_.get(), CloudBuffer(TestCloud(1, 1)));
  EXPECT_NE(NextComplaint().find("sensor_msgs/msg/Imu needs caps of application/x-imu"),
            std::string::npos);
}

TEST_F(Ros2Sink, ShowsItselfToTheToolsOfRos) {
  Start("ros2sink", "topic=/points type=pointcloud2 node-name=robot");
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Subscribe<PeerGraph>("ros_discovery_info",
                              "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_",
                              Qos::kReliableTransient);
  PeerGraph graph;
  ASSERT_TRUE(peer_->Take(&graph, kPatience));
  ASSERT_EQ(graph.nodes.size(), 1u);
  EXPECT_EQ(graph.nodes[0].name, "robot");
  EXPECT_TRUE(graph.nodes[0].readers.empty());
  ASSERT_EQ(graph.nodes[0].writers.size(), 1u);
  EXPECT_TRUE(std::equal(graph.participant.begin(), graph.participant.begin() + 12,
                         graph.nodes[0].writers[0].begin()));
}

/// Clouds are sent by Fast DDS to ros2src, and by ros2sink back to Fast DDS. They are as many as an
/// OS1-128 sends in a second and a half. Each has 131072 points of 24 bytes.
TEST(Ros2Bridge, CarriesWholeScansIntact) {
  constexpr unsigned kClouds = 15;
  const std::string domain = " domain-id=" + std::to_string(TestDomain());
  const std::string line = "ros2src name=src topic=/in qos=reliable depth=20" + domain +
                           " ! ros2sink name=sink topic=/out sync=false depth=20" + domain;
  std::unique_ptr<GstElement, gst::Unref> pipeline(gst_parse_launch(line.c_str(), nullptr));
  ASSERT_TRUE(pipeline);
  const std::unique_ptr<GstElement, gst::Unref> sink(
      gst_bin_get_by_name(GST_BIN(pipeline.get()), "sink"));
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  FastPeer in(TestDomain());
  FastPeer out(TestDomain());
  in.Advertise<PeerCloud>("rt/in", kCloudType, Qos::kReliable);
  out.Subscribe<PeerCloud>("rt/out", kCloudType, Qos::kReliable);
  ASSERT_TRUE(in.WaitForMatch(kPatience));
  PeerCloud taken;
  // The sink makes its topic when it gets the first cloud. Cyclone skips messages that a publisher
  // sent before its first heartbeat. Therefore the test repeats the first cloud.
  const PeerCloud first = TestCloud(1024, 128);
  ASSERT_TRUE(Eventually([&] {
    in.Publish(first);
    return out.Take(&taken, std::chrono::milliseconds(100));
  }));
  auto next = std::chrono::steady_clock::now();
  for (unsigned i = 0; i < kClouds; ++i) {
    const PeerCloud cloud = TestCloud(1024, 128, i + 10);
    guint64 timed_out = StatOf(sink.get(), "messages-timed-out");
    ASSERT_TRUE(in.Publish(cloud));
    ASSERT_TRUE(Eventually([&] {
      // The sink drops a cloud if the peer does not read for a while. The test then repeats it.
      const guint64 before = std::exchange(timed_out, StatOf(sink.get(), "messages-timed-out"));
      if (timed_out > before) in.Publish(cloud);
      // Copies of earlier clouds may still arrive.
      return out.Take(&taken, std::chrono::milliseconds(100)) &&
             taken.header.sec >= cloud.header.sec;
    })) << i;
    ASSERT_EQ(taken.header.sec, cloud.header.sec);
    ASSERT_EQ(taken.header.frame_id, "os_lidar");
    ASSERT_TRUE(taken.data == cloud.data) << i;
    next += std::chrono::milliseconds(100);
    std::this_thread::sleep_until(next);
  }
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
}

}  // namespace
}  // namespace lidar::test
