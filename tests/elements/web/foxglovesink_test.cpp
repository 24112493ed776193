// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "gst/common/latency.h"
#include "src/rtcp/sender_report.h"
#include "tests/elements/scream/pipeline.h"
#include "tests/elements/web/web_peer.h"
#include "tests/support/element_bus.h"
#include "tests/support/proto_reader.h"

namespace lidar::test {
namespace {

constexpr GstClockTime kCapture_ns = 1'700'000'000'000'000'007;

ProtoMessage Parse(const Received& received) {
  ProtoMessage message(
      {reinterpret_cast<const std::uint8_t*>(received.payload.data()), received.payload.size()});
  EXPECT_TRUE(message.whole());
  return message;
}

float FirstX(const Received& received) {
  float x = 0;
  const std::string data = Parse(received).Text(6);
  if (data.size() >= sizeof x) std::memcpy(&x, data.data(), sizeof x);
  return x;
}

TEST(FoxgloveSink, SendsCloudsToWhoeverSubscribes) {
  Sink sink;
  sink.SetCloudCaps();
  Peer peer(&sink);
  ASSERT_TRUE(peer.connected());
  peer.Subscribe("/points", 42);
  EXPECT_EQ(peer.server_info["op"], "serverInfo");
  EXPECT_EQ(peer.channels["/points"]["schemaName"], "foxglove.PointCloud");
  ASSERT_EQ(sink.PushCloud(7, 4, kCapture_ns), GST_FLOW_OK);
  const Received received = peer.Next();
  EXPECT_EQ(received.subscription, 42U);
  EXPECT_EQ(received.unix_ns, kCapture_ns);
  EXPECT_EQ(FirstX(received), 7.0F);
  EXPECT_EQ(Parse(received).Text(6).size(), 4 * 16U);
  EXPECT_EQ(Parse(received).Text(2), "lidar");
  EXPECT_EQ(sink.Stat("points-sent"), 4U);
}

struct FramesCase {
  const char* caps;
  const char* properties;
  const char* parent;
  const char* child;
};
class FoxgloveFrames : public ::testing::TestWithParam<FramesCase> {};
TEST_P(FoxgloveFrames, OfATransformAreThoseOfThePadElseOfTheCaps) {
  Sink sink(GetParam().properties);
  const std::string caps = std::string("application/x-odometry") + GetParam().caps;
  gst_harness_set_src_caps_str(sink.harness(), caps.c_str());
  Peer peer(&sink);
  peer.Subscribe("/tf", 1);
  ASSERT_EQ(gst_harness_push(sink.harness(), gst_buffer_new_allocate(nullptr, 64, nullptr)),
            GST_FLOW_OK);
  const Received transform = peer.Next();
  EXPECT_EQ(Parse(transform).Text(2), GetParam().parent);
  EXPECT_EQ(Parse(transform).Text(3), GetParam().child);
}
INSTANTIATE_TEST_SUITE_P(
    All, FoxgloveFrames,
    ::testing::Values(FramesCase{"", "", "odom", "lidar"},
                      FramesCase{",frame-id=map,child-frame-id=odom", "", "map", "odom"},
                      FramesCase{",child-frame-id=os", "sink_0::frame-id=os1", "odom", "os1"}));

TEST(FoxgloveSink, SpeaksBothSubprotocolsWithoutCompression) {
  Sink sink;
  for (const char* protocol : {"foxglove.sdk.v1", "foxglove.websocket.v1"}) {
    Peer peer(sink.Url("ws"), {"other", protocol});
    ASSERT_TRUE(peer.connected()) << protocol;
    EXPECT_EQ(peer.protocol(), protocol);
    EXPECT_FALSE(peer.compressed());
  }
  EXPECT_FALSE(Peer(sink.Url("ws"), {"chat"}).connected());
  EXPECT_FALSE(Peer(sink.Url("ws"), {}).connected());
  EXPECT_EQ(sink.Stat("malformed"), 2U);
}

TEST(FoxgloveSink, ServesSeveralClientsEachWhatItAskedFor) {
  Sink sink;
  sink.SetCloudCaps();
  Peer first(&sink);
  Peer second(&sink);
  first.Subscribe("/points", 1);
  second.Subscribe("/points", 2);
  sink.PushCloud(1);
  EXPECT_EQ(first.Next().subscription, 1U);
  EXPECT_EQ(second.Next().subscription, 2U);
  first.SendText(R"({"op":"unsubscribe","subscriptionIds":[1]})");
  first.Sync();
  sink.PushCloud(2);
  EXPECT_EQ(FirstX(second.Next()), 2.0F);
  first.Sync();
  EXPECT_TRUE(first.received.empty());
}

TEST(FoxgloveSink, EncodesNothingThatNobodyWants) {
  Sink sink;
  sink.SetCloudCaps();
  sink.PushCloud(1);
  EXPECT_EQ(sink.Stat("clouds"), 1U);
  EXPECT_EQ(sink.Stat("points-sent"), 0U);
}

TEST(FoxgloveSink, TellsTheScanDurationOfTheNewestCapsOfScans) {
  Sink sink;
  EXPECT_EQ(sink.Stat("scan-duration"), 0U);
  sink.SetCloudCaps();
  EXPECT_EQ(sink.Stat("scan-duration"), 100 * GST_MSECOND);
  for (const char* caps : {GST_LIDAR_ODOMETRY_MEDIA_TYPE, "video/x-vp8,framerate=(fraction)30/1"}) {
    Harness other(gst_harness_new_with_element(sink.element(), "sink_%u", nullptr));
    gst_harness_set_src_caps_str(other.get(), caps);
    EXPECT_EQ(sink.Stat("scan-duration"), 100 * GST_MSECOND) << caps;
  }
  Harness draco(gst_harness_new_with_element(sink.element(), "sink_%u", nullptr));
  gst_harness_set_src_caps_str(
      draco.get(), "application/x-draco,geometry=xyz,alignment=slice,framerate=(fraction)20/1");
  EXPECT_EQ(sink.Stat("scan-duration"), 50 * GST_MSECOND);
}

TEST(FoxgloveSink, OfTwoSubscriptionsOfATopicTheNewestCounts) {
  Sink sink;
  sink.SetCloudCaps();
  Peer peer(&sink);
  peer.Subscribe("/points", 1);
  peer.Subscribe("/points", 2);
  sink.PushCloud(7);
  EXPECT_EQ(peer.Next().subscription, 2U);
  const guint64 sent = sink.Stat("points-sent");
  peer.SendText(R"({"op":"unsubscribe","subscriptionIds":[1]})");  // subscription 2 replaced it
  peer.Sync();
  sink.PushCloud(8);
  EXPECT_EQ(FirstX(peer.Next()), 8.0F);
  EXPECT_GT(sink.Stat("points-sent"), sent);
  // Without subscription 2 the topic has no subscriber.
  peer.SendText(R"({"op":"unsubscribe","subscriptionIds":[2]})");
  peer.Sync();
  const guint64 before = sink.Stat("points-sent");
  sink.PushCloud(9);
  EXPECT_EQ(sink.Stat("points-sent"), before);
  EXPECT_EQ(sink.Stat("clouds"), 3U);
}

TEST(FoxgloveSink, ASubscriptionIdNamesOneChannel) {
  Sink sink;
  sink.SetCloudCaps();
  Peer peer(&sink);
  peer.Subscribe("/points", 1);
  const std::size_t before = peer.statuses.size();
  peer.Subscribe("/statistics", 1);
  EXPECT_EQ(peer.statuses.size(), before + 2);  // one for the refused request, one for Sync()
  EXPECT_EQ(sink.Stat("malformed"), 1U);
  peer.Subscribe("/points", 1);  // repeating a subscription is no error
  EXPECT_EQ(sink.Stat("malformed"), 1U);
  peer.SendText(R"({"op":"unsubscribe","subscriptionIds":[1]})");
  peer.Sync();
  const guint64 sent = sink.Stat("points-sent");
  sink.PushCloud(1);
  EXPECT_EQ(sink.Stat("points-sent"), sent);
}

TEST(FoxgloveSink, TheSubscriptionIdOfATopicThatWentIsFree) {
  Sink sink;
  sink.SetCloudCaps();
  Peer peer(&sink);
  {
    Harness second(gst_harness_new_with_element(sink.element(), "sink_7", nullptr));
    gst_harness_set_src_caps_str(second.get(), GST_LIDAR_ODOMETRY_MEDIA_TYPE);
    peer.Subscribe("/pose_7", 1);
    gst_element_release_request_pad(
        sink.element(), gst::PadPtr(gst_element_get_static_pad(sink.element(), "sink_7")).get());
  }
  ASSERT_TRUE(WaitUntil([&] { return peer.channels.count("/pose_7") == 0; }));
  peer.Subscribe("/points", 1);
  ASSERT_EQ(sink.Stat("malformed"), 0U);
  sink.PushCloud(7);
  EXPECT_EQ(FirstX(peer.Next()), 7.0F);
}

TEST(FoxgloveSink, AClientThatGoesWantsNothingAnyMore) {
  Sink sink;
  sink.SetCloudCaps();
  {
    Peer peer(&sink);
    peer.Subscribe("/points", 1);
    sink.PushCloud(7);
    EXPECT_EQ(FirstX(peer.Next()), 7.0F);
  }
  ASSERT_TRUE(WaitUntil([&] { return sink.Stat("clients") == 0; }));
  const guint64 before = sink.Stat("points-sent");
  const guint64 bytes = sink.Stat("bytes-sent");
  EXPECT_GT(bytes, 64U);
  sink.PushCloud(8);
  EXPECT_EQ(sink.Stat("points-sent"), before);
  // The counters also include the client that has left.
  Peer second(&sink);
  second.Subscribe("/points", 1);
  sink.PushCloud(9);
  EXPECT_EQ(FirstX(second.Next()), 9.0F);
  EXPECT_TRUE(WaitUntil([&] {
    return sink.Stat("messages-sent") == 2 && sink.Stat("bytes-sent") >= bytes + bytes / 2;
  }));
}

TEST(FoxgloveSink, ThinsCloudsToMaxPoints) {
  Sink sink("max-points=10");
  sink.SetCloudCaps(100);
  Peer peer(&sink);
  peer.Subscribe("/points", 1);
  sink.PushCloud(1, 100);
  EXPECT_EQ(Parse(peer.Next()).Text(6).size(), 10 * 16U);
}

TEST(FoxgloveSink, PassesDracoOnAsItIs) {
  Sink sink;
  gst_harness_set_src_caps_str(sink.harness(), "application/x-draco,geometry=xyz,alignment=slice");
  Peer peer(&sink);
  peer.Subscribe("/points_draco", 5);
  EXPECT_EQ(peer.channels["/points_draco"]["schemaName"], "foxglove.CompressedPointCloud");
  gst_harness_push(sink.harness(), gst_buffer_new_memdup("DRACO", 5));
  const Received received = peer.Next();
  EXPECT_EQ(Parse(received).Text(4), "DRACO");
  EXPECT_EQ(Parse(received).Text(5), "draco");
}

TEST(FoxgloveSink, RefusesDracoOfRanges) {
  Sink sink;
  gst_harness_set_src_caps_str(sink.harness(), "application/x-draco,geometry=range");
  EXPECT_EQ(gst_harness_push(sink.harness(), gst_buffer_new_memdup("DRACO", 5)),
            GST_FLOW_NOT_NEGOTIATED);
}

TEST(FoxgloveSink, SendsPosesAsTransformsToo) {
  Sink sink("sink_0::frame-id=os1");
  gst_harness_set_src_caps_str(sink.harness(), GST_LIDAR_ODOMETRY_MEDIA_TYPE);
  Peer peer(&sink);
  peer.Subscribe("/pose", 1);
  peer.Subscribe("/tf", 2);
  const std::array<double, 8> words = {1, 2, 3, 0, 0, 0, 1, 0};
  gst_harness_push(sink.harness(), gst_buffer_new_memdup(words.data(), sizeof words));
  std::map<std::uint32_t, Received> got;
  for (int i = 0; i < 2; ++i) {
    const Received received = peer.Next();
    got[received.subscription] = received;
  }
  EXPECT_EQ(Parse(got[1]).Message(3).Message(1).Double(3), 3.0);
  EXPECT_EQ(Parse(got[2]).Text(2), "odom");
  EXPECT_EQ(Parse(got[2]).Text(3), "os1");
  EXPECT_EQ(Parse(got[2]).Message(4).Double(1), 1.0);
}

TEST(FoxgloveSink, SendsThePosesThatOdometryPutOnClouds) {
  Sink sink;
  sink.SetCloudCaps();
  Peer peer(&sink);
  peer.Subscribe("/points", 1);
  std::vector<float> point = {1, 0, 0, 0};
  const GstLidarPose pose = {{4, 5, 6}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
  const auto push = [&] {
    GstBuffer* buffer = gst_buffer_new();
    point.resize(16, 1);
    gst_buffer_append_memory(buffer, gst_memory_new_wrapped(GST_MEMORY_FLAG_READONLY, point.data(),
                                                            64, 0, 64, nullptr, nullptr));
    gst_lidar_buffer_set_pose(buffer, &pose);
    gst_harness_push(sink.harness(), buffer);
  };
  push();
  EXPECT_EQ(peer.Next().subscription, 1U);
  peer.Subscribe("/tf", 2);
  push();
  const Received transform = peer.Next();  // the transform comes before its cloud
  ASSERT_EQ(transform.subscription, 2U);
  EXPECT_EQ(Parse(transform).Message(4).Double(3), 6.0);
  EXPECT_EQ(peer.Next().subscription, 1U);
}

std::string UrlOf(GstElement* web) {
  return "ws://127.0.0.1:" + std::to_string(StatOf(web, "port"));
}

TEST(FoxgloveSink, TellsTheStatisticsOfThePipelineAroundIt) {
  Pipeline pipeline(
      "lidartestsrc is-live=true mode=512x10 model=os0-32 ! tee name=t "
      "t. ! queue ! lidarenc name=enc ! fakesink "
      "t. ! queue ! foxglovesink name=web port=0");
  pipeline.Play();
  Peer peer(UrlOf(pipeline.Get("web").get()), {"foxglove.sdk.v1"});
  peer.Subscribe("/statistics", 3);
  nlohmann::json message = nlohmann::json::object();
  EXPECT_TRUE(Eventually([&] {
    const Received received = peer.Next();
    message = nlohmann::json::parse(received.payload);
    EXPECT_NEAR(1e-9 * static_cast<double>(received.unix_ns), message["timestamp"]["sec"], 60);
    return message.value("step", 0.0) > 0;
  }));
  EXPECT_GT(message["timestamp"]["sec"], 0);
  EXPECT_EQ(message["elements"]["enc"]["factory"], "lidarenc");
  EXPECT_GT(message["elements"]["enc"]["slices"], 0);
  EXPECT_EQ(message["elements"]["web"]["clients"], 1);
}

void PushTo(GstElement* source, const std::vector<std::uint8_t>& bytes) {
  const gst::BufferPtr buffer(gst_buffer_new_memdup(bytes.data(), bytes.size()));
  GstFlowReturn flow = GST_FLOW_ERROR;
  g_signal_emit_by_name(source, "push-buffer", buffer.get(), &flow);
  EXPECT_EQ(flow, GST_FLOW_OK);
}

TEST(FoxgloveSink, TellsAtTheReceiverWhatTheSenderReports) {
  Pipeline pipeline(
      "appsrc name=in caps=application/x-rtp ! screamrx name=rx ! fakesink sync=false async=false "
      "foxglovesink name=web port=0");
  const gst::ElementPtr in = pipeline.Get("in");
  pipeline.Play();
  rtcp::SenderReport report;
  report.ssrc = 7;
  report.target_bitrate = DataRate::BitsPerSecond(9e6);
  report.rtt = std::chrono::milliseconds(30);
  PushTo(in.get(), {0x80, 96, 0, 1, 0, 0, 0, 0, 0, 0, 0, 7, 1, 2, 3, 4});
  PushTo(in.get(), rtcp::BuildSenderReport(report));
  Peer peer(UrlOf(pipeline.Get("web").get()), {"foxglove.sdk.v1"});
  peer.Subscribe("/statistics", 3);
  nlohmann::json message = nlohmann::json::object();
  EXPECT_TRUE(Eventually([&] {
    message = nlohmann::json::parse(peer.Next().payload);
    return message.contains("rtt");
  }));
  EXPECT_EQ(message.value("target_bitrate", 0), 9'000'000);
  EXPECT_EQ(message.value("rtt", 0.0), 30.0);
  EXPECT_EQ(message["elements"]["rx"]["sender_reports"], 1);
}

TEST(FoxgloveSink, TellsClientsOfPadsThatComeAndGo) {
  Sink sink;
  sink.SetCloudCaps();
  Peer peer(&sink);
  peer.Channel("/points");
  {
    Harness second(gst_harness_new_with_element(sink.element(), "sink_7", nullptr));
    gst_harness_set_src_caps_str(second.get(), GST_LIDAR_ODOMETRY_MEDIA_TYPE);
    const std::array<double, 8> words = {0, 0, 0, 0, 0, 0, 1, 0};
    gst_harness_push(second.get(), gst_buffer_new_memdup(words.data(), sizeof words));
    peer.Channel("/pose_7");
    const gst::PadPtr next(gst_element_request_pad_simple(sink.element(), "sink_%u"));
    EXPECT_STREQ(GST_OBJECT_NAME(next.get()), "sink_8");
    const gst::PadPtr earlier(gst_element_request_pad_simple(sink.element(), "sink_3"));
    const gst::PadPtr last(gst_element_request_pad_simple(sink.element(), "sink_%u"));
    EXPECT_STREQ(GST_OBJECT_NAME(last.get()), "sink_9");
    for (GstPad* pad : {next.get(), earlier.get(), last.get()})
      gst_element_release_request_pad(sink.element(), pad);
    gst_element_release_request_pad(
        sink.element(), gst::PadPtr(gst_element_get_static_pad(sink.element(), "sink_7")).get());
  }
  EXPECT_TRUE(WaitUntil([&] { return peer.channels.count("/pose_7") == 0; }));
  EXPECT_EQ(peer.channels.count("/points"), 1U);
}

TEST(FoxgloveSink, AsksASourceWithoutBufferForNone) {
  const gst::ElementPtr pipeline(gst_parse_launch(
      "appsrc is-live=true min-latency=0 max-latency=0 caps=" GST_LIDAR_ODOMETRY_MEDIA_TYPE
      " ! foxglovesink port=0",
      nullptr));
  ASSERT_TRUE(pipeline);
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  const gst::QueryPtr query(gst_query_new_latency());
  EXPECT_TRUE(gst_element_query(pipeline.get(), query.get()));
  EXPECT_EQ(gst::ReadLatency(query.get()).min, 0U);
  const ElementBus bus(pipeline.get());
  const gst::MessagePtr warning = bus.Pop(GST_MESSAGE_WARNING);
  EXPECT_EQ(warning, nullptr);
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
}

TEST(FoxgloveSink, RefusesOneTopicForTwoKindsOfMessages) {
  for (const char* caps : {GST_LIDAR_ODOMETRY_MEDIA_TYPE, "video/x-vp8",
                           "application/x-draco,geometry=xyz,alignment=slice"}) {
    Sink sink("sink_1::topic=/points");
    sink.SetCloudCaps();
    sink.PushCloud(1);
    const ElementBus bus(sink.element());
    Harness second(gst_harness_new_with_element(sink.element(), "sink_1", nullptr));
    gst_harness_set_src_caps_str(second.get(), caps);
    EXPECT_EQ(bus.Text(GST_MESSAGE_ERROR),
              "Cannot show this stream: the topic \"/points\" is already used for other data; set "
              "the property topic of one of its pads.");
    const std::array<double, 8> words = {};
    EXPECT_EQ(gst_harness_push(second.get(), gst_buffer_new_memdup(words.data(), sizeof words)),
              GST_FLOW_NOT_NEGOTIATED);
  }
}

TEST(FoxgloveSink, APadTellsItsPropertiesAsTheyWereSet) {
  Sink sink("sink_1::topic=/r7/points sink_1::frame-id=os1 sink_1::recording=/tmp/r7.mcap");
  const auto texts_of = [](GstPad* pad) {
    std::string texts;
    for (const char* property : {"topic", "frame-id", "recording"}) {
      gchar* raw = nullptr;
      g_object_get(pad, property, &raw, nullptr);
      const gst::StringPtr text(raw);
      texts += std::string(text ? text.get() : "NULL") + " ";
    }
    return texts;
  };
  const gst::PadPtr first(gst_element_get_static_pad(sink.element(), "sink_0"));
  const gst::PadPtr second(gst_element_request_pad_simple(sink.element(), "sink_1"));
  EXPECT_EQ(texts_of(first.get()), "NULL lidar NULL ");
  EXPECT_EQ(texts_of(second.get()), "/r7/points os1 /tmp/r7.mcap ");
  gst_element_release_request_pad(sink.element(), second.get());
}

class PosesOfClouds : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, PosesOfClouds, ::testing::Values("/pose", "/tf"));
TEST_P(PosesOfClouds, AreNotShownIfTheirTopicIsInUseWhichIsSaidOnce) {
  const std::string topic = GetParam();
  Sink sink("sink_1::topic=" + topic);
  sink.SetCloudCaps();
  sink.PushCloud(1);
  const ElementBus bus(sink.element());
  Harness second(gst_harness_new_with_element(sink.element(), "sink_1", nullptr));
  const gst::CapsPtr caps(gst_pad_get_current_caps(sink.harness()->srcpad));
  gst_harness_set_src_caps(second.get(), gst_caps_ref(caps.get()));
  const GstLidarPose pose = {{4, 5, 6}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
  const auto push = [&] {
    GstBuffer* buffer = gst_buffer_new_allocate(nullptr, 64, nullptr);
    gst_buffer_memset(buffer, 0, 0, 64);
    gst_lidar_buffer_set_pose(buffer, &pose);
    EXPECT_EQ(gst_harness_push(sink.harness(), buffer), GST_FLOW_OK);
  };
  for (int i = 0; i < 2; ++i) push();
  EXPECT_EQ(bus.Texts(GST_MESSAGE_WARNING),
            std::vector<std::string>{
                "The poses of the clouds are not shown: the topic \"" + topic +
                "\" is already used for other data; set the property topic of one of its pads."});
  // The next run shows the poses: the stream that uses the topic has not begun.
  gst_element_set_state(sink.element(), GST_STATE_NULL);
  gst_element_set_state(sink.element(), GST_STATE_PLAYING);
  gst_harness_push_event(sink.harness(), gst_event_new_stream_start("again"));
  sink.SetCloudCaps();
  push();
  Peer peer(&sink);
  peer.Subscribe("/pose", 1);
  peer.Subscribe("/tf", 2);
  push();
  std::set<std::uint32_t> shown;
  for (int i = 0; i < 2; ++i) shown.insert(peer.Next().subscription);
  EXPECT_EQ(shown, (std::set<std::uint32_t>{1, 2}));
  EXPECT_TRUE(bus.Texts(GST_MESSAGE_WARNING).empty());
}

TEST(FoxgloveSink, GoesOnAfterFlushesAndNewStarts) {
  Sink sink;
  sink.SetCloudCaps();
  sink.PushCloud(1);
  EXPECT_TRUE(gst_harness_push_event(sink.harness(), gst_event_new_flush_start()));
  EXPECT_TRUE(gst_harness_push_event(sink.harness(), gst_event_new_flush_stop(TRUE)));
  gst_harness_push_event(sink.harness(), NewSegment());
  EXPECT_EQ(sink.PushCloud(2), GST_FLOW_OK);
  Peer peer(&sink);
  EXPECT_TRUE(peer.connected());
  gst_element_set_state(sink.element(), GST_STATE_NULL);
  EXPECT_TRUE(WaitUntil([&] { return peer.closed(); }));
  EXPECT_EQ(sink.Stat("port"), 0U);
  gst_element_set_state(sink.element(), GST_STATE_PLAYING);
  EXPECT_TRUE(Peer(&sink).connected());
}

TEST(FoxgloveSink, CountsBuffersOfAWrongSizeAndGoesOn) {
  Sink sink;
  sink.SetCloudCaps();
  EXPECT_EQ(gst_harness_push(sink.harness(), gst_buffer_new_memdup("short", 5)), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_push(sink.harness(), gst_buffer_new()), GST_FLOW_OK);
  EXPECT_EQ(sink.Stat("malformed"), 2U);
  EXPECT_EQ(sink.PushCloud(1), GST_FLOW_OK);
}

}  // namespace
}  // namespace lidar::test
