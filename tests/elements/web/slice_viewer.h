// SPDX-License-Identifier: LGPL-2.1-or-later
// A robot that sends slices, an edge that serves them, and a viewer that decodes them as the web
// page does.
#pragma once
#include <gtest/gtest.h>

#include <vector>

#include "src/base/base64.h"
#include "src/codec/slice_decoder.h"
#include "tests/elements/web/web_peer.h"

namespace lidar::test {

constexpr guint kScanSlices = 4;  // slices per scan

inline gst::CapsPtr CapsOf(GstHarness* harness) {
  return gst::CapsPtr(gst_pad_get_current_caps(harness->sinkpad));
}

/// Slices of clouds from a sensor that does not move. All robots share these slices, because
/// rendering them takes longer than everything else in a test.
class StillClouds {
 public:
  static constexpr std::size_t kSlices = 700;

  static const StillClouds& Get() {
    // Never deleted, so that it is not destroyed after GStreamer was deinitialised.
    static const auto* const clouds = new StillClouds;
    return *clouds;
  }
  GstBuffer* At(std::size_t i) const { return slices_.at(i).get(); }
  GstCaps* caps() const { return caps_.get(); }

 private:
  StillClouds() {
    const std::string source =
        "lidartestsrc model=os0-32 mode=512x10 slices-per-scan=4 speed=0 num-buffers=" +
        std::to_string(kSlices);
    Harness harness(gst_harness_new_parse(source.c_str()));
    gst_harness_play(harness.get());
    while (slices_.size() < kSlices) slices_.emplace_back(gst_harness_pull(harness.get()));
    caps_ = CapsOf(harness.get());
  }

  std::vector<gst::BufferPtr> slices_;
  gst::CapsPtr caps_;
};

/// Codes the slices of a sensor that does not move. Each slice is acknowledged at once, so that
/// later slices can refer to it.
class Robot {
 public:
  explicit Robot(const std::string& options = "effort=2")
      : coder_(gst_harness_new_parse(("lidarenc key-interval=0 " + options).c_str())) {
    gst_harness_set_src_caps(coder_.get(), gst_caps_ref(StillClouds::Get().caps()));
  }
  gst::BufferPtr Next() {
    GstBuffer* cloud = StillClouds::Get().At(sent_++);
    EXPECT_EQ(gst_harness_push(coder_.get(), gst_buffer_ref(cloud)), GST_FLOW_OK);
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
  /// Requests a key unit, so that the next slices refer to no earlier slices.
  void AskForKey() {
    gst_harness_push_upstream_event(
        coder_.get(), gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM,
                                           gst_structure_new_empty("GstForceKeyUnit")));
  }

 private:
  Harness coder_;
  std::size_t sent_ = 0;
};

/// Parses the header of a slice message, as the web page does.
struct SliceReader {
  explicit SliceReader(const Received& received)
      : in(reinterpret_cast<const std::uint8_t*>(received.payload.data()),
           received.payload.size()) {
    version = in.U8();
    flags = in.U8();
    index = in.Le16();
    count = in.Le16();
    replay = in.Le16();
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
  std::uint32_t replay = 0;
  std::uint32_t scan = 0;
  std::uint32_t first_column = 0;
  std::uint64_t sent_ns = 0;
  ByteView slice;
};

/// A viewer that decodes slices and acknowledges them, as the web page does.
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
  /// Receives the next slice and decodes it. In a replay, the poses of a slice arrive before the
  /// slice.
  void Draw(bool acknowledge = true) {
    for (last = peer.Next(); (SliceReader(last).flags & 2) != 0; last = peer.Next())
      poses.push_back(last);
    const SliceReader slice(last);
    EXPECT_TRUE(decoder_->Decode(slice.slice)) << slice.scan << "." << slice.index;
    // The server sends the robot's slice unchanged, or recodes it.
    EXPECT_EQ(slice.first_column, slice.index * 512 / slice.count);
    if (slice.flags == 0) ++own;
    if (slice.flags == 1) ++recoded;
    if (acknowledge) Acknowledge(slice.scan, slice.index);
  }
  /// Acknowledges a slice, and waits until the server has the acknowledgement. If the next scan
  /// came earlier, the server would skip it for this viewer.
  void Acknowledge(std::uint32_t scan, std::uint32_t index, unsigned subscription = 9) {
    peer.SendText(nlohmann::json{
        {"op", "drawn"}, {"subscriptionId", subscription}, {"scan", scan}, {"slice", index}}
                      .dump());
    peer.Sync();
  }

  Peer peer;
  Received last;
  std::vector<Received> poses;
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
  std::string Push() { return Push(robot.Next()); }
  std::string Push(gst::BufferPtr buffer) {
    if (!has_caps) gst_harness_set_src_caps(sink.harness(), robot.caps().release());
    has_caps = true;
    GstMapInfo map;
    gst_buffer_map(buffer.get(), &map, GST_MAP_READ);
    std::string bytes(reinterpret_cast<const char*>(map.data), map.size);
    gst_buffer_unmap(buffer.get(), &map);
    EXPECT_EQ(gst_harness_push(sink.harness(), buffer.release()), GST_FLOW_OK);
    return bytes;
  }
  /// Returns the number of key units that the element has requested from the robot.
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

}  // namespace lidar::test
