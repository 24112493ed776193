// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cdr/messages.h"
#include "src/cdr/point_cloud2.h"
#include "tests/elements/ros2/ros2_support.h"

namespace lidar::test {
namespace {

using gst::BufferPtr;
using Qos = FastPeer::Qos;

/// A fixture with a ros2src and a Fast DDS publisher that matches it.
class Ros2Src : public Ros2Test {
 protected:
  void StartWithPeer(const std::string& properties = "", const std::string& behind = "") {
    Start("ros2src", "topic=/points " + properties, behind);
    peer_ = std::make_unique<FastPeer>(TestDomain());
    peer_->Advertise<PeerCloud>("rt/points", kCloudType, Qos::kReliable);
    ASSERT_TRUE(peer_->WaitForMatch(kPatience));
    ASSERT_TRUE(WaitForStat("publishers", 1));
    PublishUntil("messages-empty", TestCloud(0, 1));
  }
  /// Starts with a peer that can publish invalid messages.
  void StartWithRawPeer(const std::string& type = kCloudType) {
    Start("ros2src", "topic=/points qos=reliable");
    peer_ = std::make_unique<FastPeer>(TestDomain());
    peer_->Advertise<PeerBytes>("rt/points", type, Qos::kReliable);
  }

  /// Publishes the message again and again until the counter `stat` is not 0. A message is lost if
  /// it is sent before the two endpoints match.
  template <class Message>
  void PublishUntil(const char* stat, const Message& message) {
    ASSERT_TRUE(Eventually([&] {
      EXPECT_TRUE(peer_->Publish(message));
      g_usleep(50'000);
      return Stat(stat) > 0;
    }));
  }
  guint64 MessagesWithPoints() { return Stat("messages") - Stat("messages-empty"); }

  std::unique_ptr<FastPeer> peer_;
};

TEST_F(Ros2Src, TakesCloudsOfFastDdsWithStampFrameAndFields) {
  StartWithPeer();
  PeerCloud cloud = TestCloud(64, 16);
  cloud.is_dense = true;
  ASSERT_TRUE(peer_->Publish(cloud));
  const BufferPtr buffer = Pull();
  ASSERT_TRUE(buffer);
  EXPECT_EQ(BytesOf(buffer.get()), cloud.data);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffer.get()), 1'700'000'001 * GST_SECOND + kTestNs);
  EXPECT_TRUE(GST_BUFFER_PTS_IS_VALID(buffer.get()));
  EXPECT_EQ(Field("fields"), kTestFields);
  EXPECT_EQ(Field("frame-id"), "os_lidar");
  EXPECT_EQ(Field("width"), "64");
  EXPECT_EQ(Field("height"), "16");
  EXPECT_EQ(Field("is-dense"), "true");
  EXPECT_EQ(MessagesWithPoints(), 1u);
  EXPECT_GT(Stat("bytes"), cloud.data.size());
  gst_element_set_state(h_->element, GST_STATE_READY);
  EXPECT_EQ(MessagesWithPoints(), 1u);
  EXPECT_EQ(Stat("publishers"), 0u);
  gst_element_set_state(h_->element, GST_STATE_PLAYING);
  EXPECT_EQ(Stat("messages"), 0u);
  EXPECT_EQ(Stat("bytes"), 0u);
}

TEST_F(Ros2Src, TakesMessagesOfLivox) {
  Start("ros2src", "topic=/points type=livox qos=reliable");
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Advertise<PeerBytes>("rt/points", "livox_ros_driver2::msg::dds_::CustomMsg_",
                              Qos::kReliable);
  ASSERT_TRUE(peer_->WaitForMatch(kPatience));
  ASSERT_TRUE(WaitForStat("publishers", 1));
  constexpr std::uint32_t kPoints = 20'000;
  std::vector<std::uint8_t> message;
  cdr::CdrWriter w(&message);
  cdr::WriteHeader(
      {Time{} + Duration{1'700'000'000 * Duration(std::chrono::seconds(1)).count()}, "livox_frame"},
      &w);
  w.U64(1'700'000'000'000'000'000);
  w.U32(kPoints);
  w.U32(0);
  w.U32(kPoints);
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    w.U32(5'000 * i);
    for (int axis = 0; axis < 3; ++axis) w.F32(static_cast<float>(i));
    for (int k = 0; k < 3; ++k) w.U8(1);
  }
  PublishUntil("messages", PeerBytes{message});
  const BufferPtr buffer = Pull();
  ASSERT_TRUE(buffer);
  EXPECT_EQ(gst_buffer_get_size(buffer.get()), 26U * kPoints);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffer.get()), 1'700'000'000 * GST_SECOND);
  EXPECT_EQ(Field("frame-id"), "livox_frame");
  EXPECT_EQ(Field("width"), "20000");
}

TEST_F(Ros2Src, FollowsCloudsThatChangeTheirLayout) {
  StartWithPeer("qos=reliable");
  for (const std::uint32_t width : {7u, 7u, 3u}) {
    const PeerCloud cloud = TestCloud(width, 1, width);
    ASSERT_TRUE(peer_->Publish(cloud));
    const BufferPtr buffer = Pull();
    EXPECT_EQ(BytesOf(buffer.get()), cloud.data);
    EXPECT_EQ(Field("width"), std::to_string(width));
  }
}

TEST_F(Ros2Src, ConvertsBigEndianDoublesForWhoeverIsBehind) {
  StartWithPeer("qos=reliable", " ! dracoenc geometry=xyz ! dracodec");
  PeerCloud cloud = TestCloud(2, 1);
  cloud.fields = {{"x", 0, 8, 1}, {"y", 8, 8, 1}, {"z", 16, 8, 1}};
  cloud.is_bigendian = true;
  cloud.data.clear();
  for (const double v : {1., 2., 3., 4., 5., 6.}) {
    std::uint8_t bytes[sizeof v];
    std::memcpy(bytes, &v, sizeof v);
    cloud.data.insert(cloud.data.end(), std::rbegin(bytes), std::rend(bytes));
  }
  ASSERT_TRUE(peer_->Publish(cloud));
  const auto points = BytesOf(Pull().get());
  ASSERT_EQ(points.size() % 12, 0u);
  ASSERT_GE(points.size(), 24u);
  float last[3];
  std::memcpy(last, points.data() + 12, sizeof last);
  // 6 or 15, because the order of points may change.
  EXPECT_NEAR(last[0] + last[1] + last[2], 15, 9.1);
}

TEST_F(Ros2Src, GivesTheFieldsAndTheRateThatAFilterNames) {
  StartWithPeer("qos=reliable", " ! capsfilter name=filter");
  const std::unique_ptr<GstElement, gst::Unref> filter(
      gst_bin_get_by_name(GST_BIN(h_->element), "filter"));
  gst_util_set_object_arg(
      G_OBJECT(filter.get()), "caps",
      "application/x-pointcloud2,fields=(string)\"t:U16:0,x:F64:2\",framerate=20/1");
  PeerCloud cloud = TestCloud(1, 1);
  const float x = 2.5f;
  const std::uint32_t t = 70'000;
  std::memcpy(cloud.data.data(), &x, sizeof x);
  std::memcpy(cloud.data.data() + 16, &t, sizeof t);
  ASSERT_TRUE(peer_->Publish(cloud));
  const auto point = BytesOf(Pull().get());
  ASSERT_EQ(point.size(), 10u);
  EXPECT_EQ(point[0], 0xFF);
  EXPECT_EQ(point[1], 0xFF);
  double wide = 0;
  std::memcpy(&wide, point.data() + 2, sizeof wide);
  EXPECT_EQ(wide, 2.5);
  EXPECT_EQ(Field("framerate"), "20/1");
  gst_util_set_object_arg(G_OBJECT(filter.get()), "caps",
                          "application/x-pointcloud2,fields=(string)\"x:F32:0\"");
  ASSERT_TRUE(peer_->Publish(cloud));
  EXPECT_EQ(gst_buffer_get_size(Pull().get()), 4u);
}

void Want(gpointer filter, const char* field) {
  const std::string caps = std::string("application/x-pointcloud2,fields=(string)") + field;
  gst_util_set_object_arg(G_OBJECT(filter), "caps", caps.c_str());
}

/// Downstream changes its caps while the source waits for a message, and while it pushes a buffer.
TEST_F(Ros2Src, GivesWhatIsWantedFromTheNextMessageOn) {
  StartWithPeer("qos=reliable", " ! capsfilter name=filter");
  const std::unique_ptr<GstElement, gst::Unref> filter(
      gst_bin_get_by_name(GST_BIN(h_->element), "filter"));
  const auto next = [this] {
    EXPECT_TRUE(peer_->Publish(TestCloud(1, 1)));
    return gst_buffer_get_size(Pull().get());
  };
  Want(filter.get(), "x:F32:0");
  for (int round = 1; round <= 2; ++round) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(next(), round == 1 ? 4U : 8U);
    const guint64 before = Stat("messages-empty");
    ASSERT_TRUE(peer_->Publish(TestCloud(0, 1)));
    ASSERT_TRUE(WaitForStat("messages-empty", before + 1));
    Want(filter.get(), round == 1 ? "x:F64:0" : "x:F32:0");
    EXPECT_EQ(next(), round == 1 ? 8U : 4U);
  }
  const gst::PadPtr pad(gst_element_get_static_pad(filter.get(), "src"));
  gst_pad_add_probe(
      pad.get(), GST_PAD_PROBE_TYPE_BUFFER,
      [](GstPad*, GstPadProbeInfo*, gpointer element) -> GstPadProbeReturn {
        Want(element, "x:F64:0");
        return GST_PAD_PROBE_REMOVE;
      },
      filter.get(), nullptr);
  EXPECT_EQ(next(), 4U);
  EXPECT_EQ(next(), 8U);
}

TEST_F(Ros2Src, DropsAndCountsWhatIsDamagedAndGoesOn) {
  StartWithRawPeer();
  ASSERT_TRUE(peer_->WaitForMatch(kPatience));
  ASSERT_TRUE(WaitForStat("publishers", 1));
  cdr::PointCloud2 cloud;
  cloud.layout = {1, 0, {{"x", 0, 7, 1}}, false, 24, 0};
  PublishUntil("messages-empty", PeerBytes{cdr::WritePointCloud2(cloud)});
  const std::vector<std::uint8_t> points(24 * 4, 7);
  cloud.layout = {1, 4, {{"x", 0, 7, 1}}, false, 24, 96};
  cloud.data = {points.data(), points.size()};
  const auto good = cdr::WritePointCloud2(cloud);
  std::vector<std::uint8_t> truncated(good.begin(), good.end() - 50);
  std::vector<std::uint8_t> huge = good;
  huge[good.size() - 1 - 96 - 1] = 0x40;  // claims 1 GiB of data
  cloud.layout.width = 5;                 // more points than the data contain
  const auto wrong_step = cdr::WritePointCloud2(cloud);
  // All invalid messages need a valid encapsulation header, because otherwise Cyclone itself
  // refuses them.
  std::vector<std::uint8_t> garbage(100, 0xFF);
  std::vector<std::uint8_t> short_one(24, 0);
  for (auto* message : {&garbage, &short_one}) std::copy_n(good.begin(), 4, message->begin());
  for (const auto& bad : {truncated, huge, wrong_step, garbage, short_one})
    ASSERT_TRUE(peer_->Publish(PeerBytes{bad}));
  ASSERT_TRUE(WaitForStat("messages-damaged", 5));
  ASSERT_TRUE(peer_->Publish(PeerBytes{good}));
  EXPECT_EQ(BytesOf(Pull().get()), points);
  EXPECT_NE(NextOwnComplaint().find("is damaged"), std::string::npos);
  EXPECT_EQ(NextComplaint(0), "");  // there is only one warning for all
  EXPECT_EQ(MessagesWithPoints(), 6u);
  ASSERT_TRUE(peer_->Publish(PeerBytes{garbage}));
  // There is another warning, because a good message came in between.
  EXPECT_NE(NextOwnComplaint().find("is damaged"), std::string::npos);
}

TEST_F(Ros2Src, CountsCloudsOfNoPoints) {
  StartWithPeer("qos=reliable");  // publishes empty clouds until the source counts one
  ASSERT_TRUE(peer_->Publish(TestCloud(2, 1)));
  EXPECT_EQ(gst_buffer_get_size(Pull().get()), 48u);
}

TEST_F(Ros2Src, TellsOfPublishersOfAnotherType) {
  StartWithRawPeer("std_msgs::msg::dds_::String_");
  const std::string text = NextOwnComplaint();
  EXPECT_NE(text.find("std_msgs::msg::dds_::String_"), std::string::npos) << text;
  EXPECT_EQ(Stat("publishers-of-other-types"), 1u);
  EXPECT_EQ(Stat("publishers"), 0u);
}

TEST_F(Ros2Src, TellsOnceHoweverManyPublishersOfOtherTypesCome) {
  StartWithRawPeer("std_msgs::msg::dds_::String_");
  std::vector<std::unique_ptr<FastPeer>> others;
  for (const char* type : {"a::A_", "b::B_", "c::C_"}) {
    others.push_back(std::make_unique<FastPeer>(TestDomain()));
    others.back()->Advertise<PeerBytes>("rt/points", type, Qos::kReliable);
  }
  ASSERT_TRUE(WaitForStat("publishers-of-other-types", 4));
  EXPECT_NE(NextOwnComplaint().find("its messages are not received"), std::string::npos);
  EXPECT_EQ(NextComplaint(0), "");
}

TEST_F(Ros2Src, TellsOfPublishersThatItsReliabilityDoesNotFit) {
  Start("ros2src", "topic=/points qos=reliable");
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Advertise<PeerCloud>("rt/points", kCloudType, Qos::kBestEffort);
  const std::string text = NextOwnComplaint();
  EXPECT_NE(text.find("best-effort"), std::string::npos) << text;
}

/// In the next run, the same warnings are posted again and the counters begin at 0.
TEST_F(Ros2Src, TellsInEachRunOfWhatDoesNotFit) {
  FastPeer best_effort(TestDomain());
  best_effort.Advertise<PeerCloud>("rt/points", kCloudType, Qos::kBestEffort);
  FastPeer other(TestDomain());
  other.Advertise<PeerBytes>("rt/points", "std_msgs::msg::dds_::String_", Qos::kReliable);
  Start("ros2src", "topic=/points qos=reliable");
  for (int run = 0; run < 2; ++run) {
    std::string complaints;
    for (int i = 0; i < 2; ++i) complaints += NextOwnComplaint();
    EXPECT_NE(complaints.find("best-effort"), std::string::npos) << run << complaints;
    EXPECT_NE(complaints.find("String_"), std::string::npos) << run << complaints;
    EXPECT_EQ(Stat("publishers-of-other-types"), 1U) << run;
    StartAgain();
  }
}

TEST_F(Ros2Src, TakesImuSamples) {
  Start("ros2src", "topic=/imu type=imu qos=reliable");
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Advertise<PeerImu>("rt/imu", "sensor_msgs::msg::dds_::Imu_", Qos::kReliable);
  ASSERT_TRUE(peer_->WaitForMatch(kPatience));
  ASSERT_TRUE(WaitForStat("publishers", 1));
  PeerImu imu;
  imu.header = {5, 6, "os_imu"};
  imu.linear_acceleration = {0.5, -0.25, 9.75};
  imu.angular_velocity = {1, 2, 3};
  PublishUntil("messages", imu);
  const auto bytes = BytesOf(Pull().get());
  ASSERT_EQ(bytes.size(), 32u);
  std::uint64_t t = 0;
  float values[6];
  std::memcpy(&t, bytes.data(), 8);
  std::memcpy(values, bytes.data() + 8, sizeof values);
  EXPECT_EQ(t, 5'000'000'006u);
  EXPECT_EQ(values[2], 9.75f);
  EXPECT_EQ(values[5], 3.f);
  EXPECT_EQ(Field("frame-id"), "os_imu");
}

TEST_F(Ros2Src, TakesOdometry) {
  Start("ros2src", "topic=/odom type=odometry qos=reliable");
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Advertise<PeerOdometry>("rt/odom", "nav_msgs::msg::dds_::Odometry_", Qos::kReliable);
  ASSERT_TRUE(peer_->WaitForMatch(kPatience));
  ASSERT_TRUE(WaitForStat("publishers", 1));
  PeerOdometry odometry;
  odometry.header = {5, 6, "odom"};
  odometry.child_frame_id = "base_link";
  odometry.pose = {1, 2, 3, 0, 0, 0.6, 0.8};
  PublishUntil("messages", odometry);
  const BufferPtr buffer = Pull();
  const auto bytes = BytesOf(buffer.get());
  ASSERT_EQ(bytes.size(), 64u);
  double pose[7];
  std::memcpy(pose, bytes.data(), sizeof pose);
  EXPECT_TRUE(std::equal(std::begin(pose), std::end(pose), odometry.pose.begin()));
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffer.get()), 5 * GST_SECOND + 6);
  EXPECT_EQ(Field("child-frame-id"), "base_link");
}

TEST_F(Ros2Src, IsLiveAndStopsWhileItWaits) {
  Start("ros2src", "topic=/points");
  const gst::QueryPtr query(gst_query_new_latency());
  ASSERT_TRUE(gst_element_query(ros_.get(), query.get()));
  gboolean live = FALSE;
  gst_query_parse_latency(query.get(), &live, nullptr, nullptr);
  EXPECT_TRUE(live);
  const gint64 begin = g_get_monotonic_time();
  for (int i = 0; i < 3; ++i) {
    EXPECT_NE(gst_element_set_state(h_->element, GST_STATE_READY), GST_STATE_CHANGE_FAILURE);
    EXPECT_NE(gst_element_set_state(h_->element, GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
  }
  EXPECT_LT(g_get_monotonic_time() - begin, 30 * G_USEC_PER_SEC);
}

TEST_F(Ros2Src, GoesOnAfterAPause) {
  StartWithPeer("qos=reliable");
  gst_element_set_state(h_->element, GST_STATE_PAUSED);
  gst_element_set_state(h_->element, GST_STATE_PLAYING);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(peer_->Publish(TestCloud(2, 1)));
    ASSERT_TRUE(Pull());
  }
}

TEST_F(Ros2Src, APublisherThatGoesIsNoMessage) {
  StartWithPeer("qos=reliable");
  ASSERT_TRUE(peer_->Publish(TestCloud(2, 1)));
  ASSERT_TRUE(Pull());
  peer_.reset();
  EXPECT_TRUE(WaitForNone("publishers"));
  EXPECT_EQ(MessagesWithPoints(), 1u);
  EXPECT_EQ(Stat("messages-damaged"), 0u);
}

TEST_F(Ros2Src, EndsAndFlushesWhileItWaits) {
  Start("ros2src", "topic=/points");
  gst_harness_push_upstream_event(h_.get(), gst_event_new_flush_start());
  gst_harness_push_upstream_event(h_.get(), gst_event_new_flush_stop(TRUE));
  gst_element_send_event(h_->element, gst_event_new_eos());
  for (;;) {
    const gst::EventPtr event(gst_harness_pull_event(h_.get()));
    ASSERT_TRUE(event);
    if (GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS) break;
  }
}

struct BadSetting {
  const char* element;
  const char* property;
  const char* value;
  const char* complaint;
};
class Ros2Settings : public ::testing::TestWithParam<BadSetting> {};

TEST_P(Ros2Settings, ThatRosDoesNotTakeAreNamed) {
  const BadSetting& bad = GetParam();
  const std::unique_ptr<GstElement, gst::Unref> element(
      GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make(bad.element, nullptr))));
  const ElementBus bus(element.get());
  g_object_set(element.get(), bad.property, bad.value, nullptr);
  EXPECT_EQ(gst_element_set_state(element.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  const std::string text = bus.Text(GST_MESSAGE_ERROR);
  EXPECT_NE(text.find(bad.complaint), std::string::npos) << text;
  gst_element_set_state(element.get(), GST_STATE_NULL);
}

INSTANTIATE_TEST_SUITE_P(
    Each, Ros2Settings,
    ::testing::Values(BadSetting{"ros2src", "topic", "/a b", "topic \"/a b\""},
                      BadSetting{"ros2src", "node-name", "1x", "node-name \"1x\""},
                      BadSetting{"ros2sink", "topic", "", "topic \"\""},
                      BadSetting{"ros2sink", "node-name", "a//b", "node-name \"a//b\""}));

TEST_F(Ros2Src, ShowsItselfToTheToolsOfRos) {
  Start("ros2src", "topic=/points node-name=/robot/edge");
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Subscribe<PeerGraph>("ros_discovery_info",
                              "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_",
                              Qos::kReliableTransient);
  PeerGraph graph;
  ASSERT_TRUE(peer_->Take(&graph, kPatience));
  ASSERT_EQ(graph.nodes.size(), 1u);
  EXPECT_EQ(graph.nodes[0].name_space, "/robot");
  EXPECT_EQ(graph.nodes[0].name, "edge");
  ASSERT_EQ(graph.nodes[0].readers.size(), 1u);
  EXPECT_TRUE(graph.nodes[0].writers.empty());
  const auto found = peer_->endpoints();
  const auto reader = std::find_if(found.begin(), found.end(), [&](const PeerEndpoint& e) {
    return e.guid == graph.nodes[0].readers[0];
  });
  ASSERT_NE(reader, found.end());
  EXPECT_EQ(reader->topic, "rt/points");
  EXPECT_EQ(reader->type, kCloudType);
  EXPECT_EQ(reader->user_data.rfind("typehash=RIHS01_9198cabf", 0), 0u);
  EXPECT_EQ(peer_->participants().at(0), "enclave=/;");
}

TEST_F(Ros2Src, HasLongGidsAndNoTypeHashInHumble) {
  Start("ros2src", "topic=/points ros-distro=humble node-name=edge");
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Subscribe<PeerBytes>("ros_discovery_info",
                              "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_",
                              Qos::kReliableTransient);
  PeerBytes graph;
  ASSERT_TRUE(peer_->Take(&graph, kPatience));
  // The terms are: the header, the Gid, the number of nodes, "/", "edge", one reader, and no
  // writer.
  EXPECT_EQ(graph.bytes.size(), 4u + 24 + 4 + (4 + 2 + 2) + (4 + 5 + 3) + (4 + 24) + 4);
  for (const PeerEndpoint& e : peer_->endpoints()) EXPECT_EQ(e.user_data, "") << e.topic;
}

}  // namespace
}  // namespace lidar::test
