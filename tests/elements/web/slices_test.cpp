// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of coded slices: sent unchanged to viewers, decoded for other clients, and recoded for
// viewers that connect late.
#include <gtest/gtest.h>

#include "src/codec/slice_links.h"
#include "tests/elements/web/slice_viewer.h"
#include "tests/support/element_bus.h"
#include "tests/support/proto_reader.h"

namespace lidar::test {
namespace {

TEST(Slices, GoToAViewerAsTheyAre) {
  Edge edge;
  const std::string first = edge.Push();
  Viewer viewer(&edge.sink);
  EXPECT_EQ(viewer.peer.channels["/points/slices"]["schemaName"], "lidar.Slice");
  EXPECT_EQ(viewer.peer.channels["/points"]["schemaName"], "foxglove.PointCloud");
  std::uint64_t bytes = 0;
  for (guint i = 1; i < 10 * kScanSlices; ++i) {
    const std::string pushed = edge.Push();
    viewer.Draw();
    const SliceReader slice(viewer.last);
    EXPECT_EQ(slice.version, 1U);
    EXPECT_EQ(slice.scan, i / kScanSlices);
    EXPECT_EQ(slice.index, i % kScanSlices);
    EXPECT_EQ(slice.count, kScanSlices);
    EXPECT_EQ(slice.first_column, i % kScanSlices * 128);
    EXPECT_GE(slice.sent_ns, viewer.last.unix_ns);
    if (slice.flags == 0) {
      EXPECT_EQ(std::string(slice.slice.begin(), slice.slice.end()), pushed);
    }
    bytes += pushed.size();
  }
  // The viewer subscribed after the first slice, so it did not get that slice.
  EXPECT_GE(viewer.own, 10 * kScanSlices - 10 - 1);
  EXPECT_LT(edge.sink.Stat("bytes-sent"), bytes * 11 / 10 + 8192);
  EXPECT_EQ(edge.sink.Stat("points-sent"), 0U);
  EXPECT_EQ(edge.key_requests(), 0U);
}

TEST(Slices, AreRecodedForAViewerThatComesLate) {
  Edge edge;
  edge.PushScans(5);
  Viewer viewer(&edge.sink);
  for (guint i = 0; i < 3 * kScanSlices; ++i) {
    edge.Push();
    viewer.Draw();
  }
  EXPECT_EQ(viewer.own, 0U);
  EXPECT_EQ(viewer.recoded, 3 * kScanSlices);
  EXPECT_EQ(edge.key_requests(), 0U);
}

TEST(Slices, AreDecodedForOthersWhileSomebodySubscribes) {
  Edge edge;
  edge.PushScans(3);
  EXPECT_EQ(edge.sink.Stat("points-sent"), 0U);
  Peer foxglove(&edge.sink);
  foxglove.Subscribe("/points", 4);
  edge.Push();
  Received cloud = foxglove.Next();
  const ProtoMessage message(
      {reinterpret_cast<const std::uint8_t*>(cloud.payload.data()), cloud.payload.size()});
  ASSERT_TRUE(message.whole());
  EXPECT_GT(message.Text(6).size(), 1000U);
  EXPECT_GT(edge.sink.Stat("points-sent"), 100U);
}

TEST(Slices, OfPointsBringTheirFurtherFields) {
  Edge edge("", "effort=1 geometry=xyz fields=range keep-order=true");
  edge.PushScans(1);
  Peer foxglove(&edge.sink);
  foxglove.Subscribe("/points", 4);
  edge.Push();
  const Received cloud = foxglove.Next();
  const ProtoMessage message(
      {reinterpret_cast<const std::uint8_t*>(cloud.payload.data()), cloud.payload.size()});
  ASSERT_EQ(message.Count(5), 5U);
  const ProtoMessage field = message.Message(5, 4);
  EXPECT_EQ(field.Text(1), "range");
  const std::string points = message.Text(6);
  ASSERT_GT(points.size(), 1000U);
  for (std::size_t at = 0; at < points.size(); at += message.Number(4)) {
    float p[3];
    std::uint32_t range_mm = 0;
    std::memcpy(p, &points[at], sizeof p);
    std::memcpy(&range_mm, &points[at + field.Number(2)], sizeof range_mm);
    // The beams begin at some distance from the centre of the sensor.
    ASSERT_NEAR(std::hypot(p[0], p[1], p[2]), 1e-3 * range_mm, 0.06);
  }
}

TEST(Slices, WhoseReferenceNeverCameAreNotDamaged) {
  Edge edge;
  for (guint i = 0; i < 5 * kScanSlices; ++i) edge.robot.Next();
  edge.PushScans(1);
  Peer foxglove(&edge.sink);
  foxglove.Subscribe("/points", 4);
  edge.robot.AskForKey();
  edge.PushScans(1);
  EXPECT_TRUE(WaitUntil([&] { return edge.sink.Stat("points-sent") > 0; }));
  EXPECT_EQ(edge.sink.Stat("malformed"), 0U);
}

TEST(Slices, ThatNobodyWantsAreDecodedBeforeTooManyWait) {
  Edge edge("", "geometry=xyz");
  edge.Push();
  EXPECT_EQ(edge.sink.Stat("malformed"), 0U);
  for (int i = 0; i < 4; ++i) {
    GstBuffer* large = edge.robot.Next().release();
    gst_buffer_append(large, gst_buffer_new_memdup(std::string(3U << 20, 'x').data(), 3U << 20));
    EXPECT_EQ(gst_harness_push(edge.sink.harness(), large), GST_FLOW_OK);
  }
  EXPECT_TRUE(WaitUntil([&] { return edge.sink.Stat("malformed") > 0; }));
}

TEST(Slices, OfNewestScansGoToAViewerThatFallsBehind) {
  Edge edge;
  edge.Push();
  Viewer viewer(&edge.sink);
  for (guint i = 1; i < 2 * kScanSlices; ++i) {
    edge.Push();
    viewer.Draw(false);
  }
  viewer.Acknowledge(1, kScanSlices - 1, 8);  // this subscription is not the viewer's
  edge.PushScans(19);
  const std::uint32_t newest = 20;
  EXPECT_TRUE(WaitUntil([&] { return edge.sink.Stat("scans-skipped") >= 15; }));
  viewer.peer.Sync();
  EXPECT_TRUE(viewer.peer.received.empty());
  viewer.Acknowledge(1, kScanSlices - 1);
  for (guint i = 0; i < kScanSlices; ++i) viewer.Draw();
  EXPECT_EQ(SliceReader(viewer.last).scan, newest);
}

TEST(Slices, TakeNoMoreThanMaxBitrate) {
  Edge edge("max-bitrate=1");
  edge.Push();
  Viewer viewer(&edge.sink);
  for (guint i = 1; i < kScanSlices; ++i) {
    edge.Push();
    viewer.Draw();
  }
  // With this bitrate, the first scan has used up the budget of many hours.
  edge.PushScans(5);
  EXPECT_TRUE(WaitUntil([&] { return edge.sink.Stat("scans-skipped") >= 3; }));
  viewer.peer.Sync();
  EXPECT_TRUE(viewer.peer.received.empty());
}

TEST(Slices, GoBeforeTheCameraOfAViewerThatFallsBehind) {
  Edge edge;
  edge.Push();
  Harness camera(gst_harness_new_with_element(edge.sink.element(), "sink_1", nullptr));
  gst_harness_set_src_caps_str(camera.get(), "video/x-vp8");
  const auto frames = [&] {
    return edge.sink.Stat("messages-sent") + edge.sink.Stat("messages-dropped");
  };
  const auto push_frame = [&](bool is_key = true) {
    const guint64 before = frames();
    GstBuffer* frame = gst_buffer_new_memdup(is_key ? "key" : "rest", is_key ? 3 : 4);
    if (!is_key) GST_BUFFER_FLAG_SET(frame, GST_BUFFER_FLAG_DELTA_UNIT);
    gst_harness_push(camera.get(), frame);
    EXPECT_TRUE(WaitUntil([&] { return frames() > before; }));
  };
  Viewer viewer(&edge.sink);
  viewer.peer.Subscribe("/camera_1", 5);
  edge.Push();
  viewer.Draw();
  viewer.peer.Sync();
  push_frame();
  EXPECT_EQ(viewer.peer.Next().subscription, 5U);
  edge.Push();
  viewer.Draw(false);
  ASSERT_TRUE(WaitUntil([&] {
    push_frame();
    return edge.sink.Stat("messages-dropped") > 0;
  }));
  viewer.Acknowledge(0, 2);
  viewer.peer.Sync();
  viewer.peer.received.clear();
  push_frame(false);  // continues the frame that was dropped
  push_frame();
  const Received next = viewer.peer.Next();
  EXPECT_EQ(next.subscription, 5U);
  EXPECT_NE(next.payload.find("key"), std::string::npos);
}

TEST(Slices, HaveTheTopicOfTheirRobot) {
  Edge edge("sink_0::topic=/r7/points");
  edge.Push();
  Peer peer(&edge.sink);
  peer.Channel("/r7/points/slices");
  const auto stream =
      nlohmann::json::parse(peer.channels["/r7/points/slices"]["schema"].get<std::string>());
  EXPECT_EQ(stream["clouds"], "/r7/points");
  peer.Channel("/r7/points");
}

TEST(Slices, AfterALackStandAlone) {
  Edge edge;
  edge.Push();
  Viewer viewer(&edge.sink);
  viewer.peer.SendText(R"({"op":"lacksReference","subscriptionId":9})");
  viewer.peer.Sync();
  for (guint i = 0; i < 2 * kScanSlices; ++i) {
    edge.Push();
    viewer.Draw();
  }
  viewer.peer.SendText(R"({"op":"lacksReference","subscriptionId":9})");
  viewer.peer.Sync();
  const unsigned before = viewer.recoded;
  for (guint i = 0; i < kScanSlices; ++i) {
    edge.Push();
    viewer.Draw();
  }
  EXPECT_EQ(viewer.recoded, before + kScanSlices);
}

TEST(Slices, ThatAreDamagedAreCountedAndGoToNobody) {
  Edge edge;
  edge.Push();
  Viewer viewer(&edge.sink);
  gst_harness_push(edge.sink.harness(), gst_buffer_new_memdup("damaged", 7));
  EXPECT_EQ(edge.sink.Stat("malformed"), 1U);
  edge.Push();
  viewer.Draw();
  EXPECT_EQ(SliceReader(viewer.last).index, 1U);
}

TEST(Slices, OfAnotherStreamHaveAnotherChannel) {
  Edge edge;
  edge.Push();
  Viewer viewer(&edge.sink);
  const auto id = viewer.peer.channels["/points/slices"]["id"].get<int>();
  gst::CapsPtr caps(gst_caps_make_writable(edge.robot.caps().release()));
  gst_caps_set_simple(caps.get(), "framerate", GST_TYPE_FRACTION, 20, 1, nullptr);
  gst_harness_set_src_caps(edge.sink.harness(), caps.release());
  EXPECT_TRUE(WaitUntil([&] {
    const auto found = viewer.peer.channels.find("/points/slices");
    return found != viewer.peer.channels.end() && found->second["id"] != id;
  }));
}

TEST(Slices, OfATopicInUseAreRefused) {
  Edge edge("sink_1::topic=/points/slices");
  const ElementBus bus(edge.sink.element());
  Harness poses(gst_harness_new_with_element(edge.sink.element(), "sink_1", nullptr));
  gst_harness_set_src_caps_str(poses.get(), GST_LIDAR_ODOMETRY_MEDIA_TYPE);
  gst::BufferPtr slice = edge.robot.Next();
  gst_harness_set_src_caps(edge.sink.harness(), edge.robot.caps().release());
  EXPECT_EQ(bus.Text(GST_MESSAGE_ERROR),
            "Cannot show these slices: the topic \"/points/slices\" is already used for other "
            "data; set the property topic of one of its pads.");
  EXPECT_EQ(gst_harness_push(edge.sink.harness(), slice.release()), GST_FLOW_NOT_NEGOTIATED);
}

TEST(Slices, WhoseCapsLackSomethingAreRefused) {
  const std::string begin = "Cannot show these slices: ";
  const std::string fields =
      "their fields lack x, y and z as F32 side by side, or have gaps between them.";
  for (const auto& [caps, error] :
       {std::pair<std::string, std::string>{"geometry=range",
                                            "geometry=range needs a sensor-model."},
        {"geometry=xyz,fields=\"x:F32:0,y:F32:4\"", fields},
        {"geometry=xyz,fields=\"x:F32:0,y:F32:4,z:F64:8\"", fields},
        {"geometry=xyz,fields=\"x:F32:0,y:F32:4,z:F32:8,t:U32:16\"", fields}}) {
    Sink sink;
    const ElementBus bus(sink.element());
    gst_harness_set_src_caps_str(sink.harness(), ("application/x-lidar-slice," + caps).c_str());
    EXPECT_EQ(bus.Text(GST_MESSAGE_ERROR), begin + error);
    EXPECT_EQ(gst_harness_push(sink.harness(), gst_buffer_new_memdup("slice", 5)),
              GST_FLOW_NOT_NEGOTIATED);
  }
}

TEST(Slices, OfPointsNeedNoSensorModel) {
  Sink sink;
  gst_harness_set_src_caps_str(
      sink.harness(),
      "application/x-lidar-slice,geometry=xyz,fields=\"x:F32:0,y:F32:4,z:F32:8,t:U32:12\"");
  Peer peer(&sink);
  peer.Channel("/points/slices");
  const auto stream =
      nlohmann::json::parse(peer.channels["/points/slices"]["schema"].get<std::string>());
  EXPECT_EQ(stream["fields"], "x:F32:0,y:F32:4,z:F32:8,t:U32:12");
}

}  // namespace
}  // namespace lidar::test
