// SPDX-License-Identifier: LGPL-2.1-or-later
// Coded slices: to viewers as they are, decoded for others, re-coded for those that came late.
#include <gtest/gtest.h>

#include "src/base/base64.h"
#include "src/codec/slice_decoder.h"
#include "src/codec/slice_links.h"
#include "tests/elements/web/web_peer.h"
#include "tests/support/proto_reader.h"

namespace lidar::test {
namespace {

constexpr guint kScanSlices = 4;  // a scan

gst::CapsPtr CapsOf(GstHarness* harness) {
  return gst::CapsPtr(gst_pad_get_current_caps(harness->sinkpad));
}

/// A sensor that stands still, and a coder that hears that each slice arrives: it refers to them,
/// however long a slow machine takes.
class Robot {
 public:
  explicit Robot(const std::string& options = "effort=2") {
    clouds_.reset(gst_harness_new_parse(
        "lidartestsrc model=os0-32 mode=512x10 slices-per-scan=4 speed=0 num-buffers=400"));
    gst_harness_play(clouds_.get());
    coder_.reset(gst_harness_new_parse(("lidarenc key-interval=0 " + options).c_str()));
  }
  gst::BufferPtr Next() {
    GstBuffer* cloud = gst_harness_pull(clouds_.get());
    if (!has_caps_) gst_harness_set_src_caps(coder_.get(), CapsOf(clouds_.get()).release());
    has_caps_ = true;
    EXPECT_EQ(gst_harness_push(coder_.get(), cloud), GST_FLOW_OK);
    gst::BufferPtr slice(gst_harness_pull(coder_.get()));
    GstLidarSlice name;
    gst_lidar_buffer_get_slice(slice.get(), &name);
    GstLidarSlicesReceived received{};
    received.receiver = 1;
    received.count = 1;
    received.slices[0] = {name.scan_id, name.slice_index};
    gst_harness_push_upstream_event(coder_.get(), gst_lidar_event_new_slices_received(&received));
    return slice;
  }
  gst::CapsPtr caps() { return CapsOf(coder_.get()); }
  /// The next slices stand alone.
  void AskForKey() {
    gst_harness_push_upstream_event(
        coder_.get(), gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM,
                                           gst_structure_new_empty("GstForceKeyUnit")));
  }

 private:
  Harness clouds_;
  Harness coder_;
  bool has_caps_ = false;
};

/// The header of a slice, as the page reads it.
struct SliceReader {
  explicit SliceReader(const Received& received)
      : in(reinterpret_cast<const std::uint8_t*>(received.payload.data()),
           received.payload.size()) {
    version = in.U8();
    flags = in.U8();
    index = in.Le16();
    count = in.Le16();
    in.Skip(2);
    scan = in.Le32();
    first_column = in.Le32();
    sent_ns = in.Le64();
    slice = in.Rest();
  }
  ByteReader in;
  unsigned version = 0;
  unsigned flags = 0;
  std::uint32_t index = 0;
  std::uint32_t count = 0;
  std::uint32_t scan = 0;
  std::uint32_t first_column = 0;
  std::uint64_t sent_ns = 0;
  ByteView slice;
};

/// A page: decodes what comes, and acknowledges it.
class Viewer {
 public:
  explicit Viewer(Sink* sink) : peer(sink) {
    peer.Subscribe("/points/slices", 9);
    const auto stream =
        nlohmann::json::parse(peer.channels["/points/slices"]["schema"].get<std::string>());
    fields_ = stream["fields"];
    const auto bytes = FromBase64(stream["sensorModel"].get<std::string>());
    const auto model = SensorModel::Parse({bytes.data(), bytes.size()});
    EXPECT_TRUE(model);
    const auto fields = PointFields::Parse(fields_);
    format_ = {
        {*fields, fields->MinimumStep()}, static_cast<std::uint32_t>(model->beams.size()), *model};
    decoder_.emplace(format_, 1U << 20);
  }
  /// The next slice; it decodes.
  void Draw(bool acknowledge = true) {
    last = peer.Next();
    const SliceReader slice(last);
    EXPECT_TRUE(decoder_->Decode(slice.slice)) << slice.scan << "." << slice.index;
    if (slice.flags == 0) ++own;
    if (slice.flags == 1) ++recoded;
    if (acknowledge) Acknowledge(slice.scan, slice.index);
  }
  /// Returns when the server has taken it: else the next scan would come while this one is on its
  /// way, and a slow machine's viewer would be left out of it.
  void Acknowledge(std::uint32_t scan, std::uint32_t index, unsigned subscription = 9) {
    peer.SendText(nlohmann::json{
        {"op", "drawn"}, {"subscriptionId", subscription}, {"scan", scan}, {"slice", index}}
                      .dump());
    peer.Sync();
  }

  Peer peer;
  Received last;
  unsigned own = 0;
  unsigned recoded = 0;

 private:
  std::string fields_;
  codec::CloudFormat format_;
  std::optional<codec::SliceDecoder> decoder_;
};

struct Edge {
  Robot robot;
  Sink sink;
  bool has_caps = false;

  explicit Edge(const std::string& properties = "", const std::string& options = "effort=2")
      : robot(options), sink(properties) {}
  std::string Push() {
    gst::BufferPtr buffer = robot.Next();
    if (!has_caps) gst_harness_set_src_caps(sink.harness(), robot.caps().release());
    has_caps = true;
    GstMapInfo map;
    gst_buffer_map(buffer.get(), &map, GST_MAP_READ);
    std::string bytes(reinterpret_cast<const char*>(map.data), map.size);
    gst_buffer_unmap(buffer.get(), &map);
    EXPECT_EQ(gst_harness_push(sink.harness(), buffer.release()), GST_FLOW_OK);
    return bytes;
  }
  /// What the element has asked the robot for.
  guint key_requests() {
    guint n = 0;
    while (const gst::EventPtr event{gst_harness_try_pull_upstream_event(sink.harness())})
      if (gst_event_has_name(event.get(), "GstForceKeyUnit")) ++n;
    return n;
  }
  void PushScans(guint n) {
    for (guint i = 0; i < n * kScanSlices; ++i) Push();
  }
};

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
  // The first slice of all came before the viewer.
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
    // Beams begin beside the sensor's middle.
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
  viewer.Acknowledge(1, kScanSlices - 1, 8);  // of another topic
  edge.PushScans(19);
  const std::uint32_t newest = 20;
  viewer.peer.Sync();
  EXPECT_TRUE(viewer.peer.received.empty());
  EXPECT_GE(edge.sink.Stat("scans-skipped"), 15U);
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
  // The scan that has begun has spent the bits of hours.
  edge.PushScans(5);
  viewer.peer.Sync();
  EXPECT_TRUE(viewer.peer.received.empty());
  EXPECT_GE(edge.sink.Stat("scans-skipped"), 3U);
}

TEST(Slices, GoBeforeTheCameraOfAViewerThatFallsBehind) {
  Edge edge;
  edge.Push();
  Harness camera(gst_harness_new_with_element(edge.sink.element(), "sink_1", nullptr));
  gst_harness_set_src_caps_str(camera.get(), "video/x-vp8");
  const auto frames = [&] {
    return edge.sink.Stat("messages-sent") + edge.sink.Stat("messages-dropped");
  };
  const auto push_frame = [&] {
    const guint64 before = frames();
    gst_harness_push(camera.get(), gst_buffer_new_memdup("key", 3));
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
  push_frame();
  EXPECT_EQ(viewer.peer.Next().subscription, 5U);
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

TEST(Slices, WithoutASensorModelAreRefused) {
  Sink sink;
  gst_harness_set_src_caps_str(sink.harness(), "application/x-lidar-slice,geometry=range");
  EXPECT_EQ(gst_harness_push(sink.harness(), gst_buffer_new_memdup("slice", 5)),
            GST_FLOW_NOT_NEGOTIATED);
}

}  // namespace
}  // namespace lidar::test
