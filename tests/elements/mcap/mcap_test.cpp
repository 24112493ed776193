// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that mcapsrc plays what mcapsink has recorded.
#include "gst/common/imu_caps.h"
#include "src/base/byte_writer.h"
#include "src/cdr/point_cloud2.h"
#include "src/mcap/writer.h"
#include "tests/elements/mcap/recording.h"

#include <atomic>
#include <fstream>
#include <set>
#include <thread>

namespace lidar::test {
namespace {

class Mcap : public Recording {};

TEST_F(Mcap, SlicesComeBackBitForBit) {
  const auto written = Record(3, "", "a.mcap");
  const auto played = Play("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
  EXPECT_EQ(played.error, "");
  ExpectSame(played.buffers.at("see"), written);
  EXPECT_EQ(played.caps.at("see"), caps_);
  EXPECT_EQ(played.stats.at("messages"), 24U);
  EXPECT_EQ(played.stats.at("files-unclosed"), 0U);
}

TEST_F(Mcap, DecodedScansAreThoseOfALiveStream) {
  const std::string live = kSensor +
                           " num-buffers=24 ! lidarenc ! tee name=t t. ! queue ! lidardec "
                           "! scanassembler ! fakesink name=see t. ! queue ! mcapsink" +
                           At("a.mcap");
  const auto direct = Play(live);
  EXPECT_EQ(direct.error, "");
  const auto played =
      Play("mcapsrc" + At("a.mcap") + " ! lidardec ! scanassembler ! fakesink name=see");
  ASSERT_EQ(played.buffers.at("see").size(), 3U);
  ExpectSame(played.buffers.at("see"), direct.buffers.at("see"));
  EXPECT_EQ(played.caps.at("see"), direct.caps.at("see"));
}

TEST_F(Mcap, CloudsComeBackWithTheirCaps) {
  const auto recorded = Play(kSensor +
                             " num-buffers=3 slices-per-scan=1 ! identity name=see "
                             "! mcapsink" +
                             At("a.mcap"));
  const auto played = Play("mcapsrc" + At("a.mcap") + " ! fakesink name=see");
  const auto& in = recorded.buffers.at("see");
  const auto& out = played.buffers.at("see");
  ASSERT_EQ(out.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(out[i].bytes, in[i].bytes);
    EXPECT_EQ(out[i].capture_time, in[i].capture_time);
    EXPECT_EQ(out[i].pts, i * 100 * GST_MSECOND);
    EXPECT_EQ(out[i].duration, 100 * GST_MSECOND);
  }
  EXPECT_EQ(played.caps.at("see"), recorded.caps.at("see"));
}

/// Records `buffers` with `caps`. Returns the buffers that are played from the recording.
std::vector<Kept> ThroughFile(const std::string& path, const char* caps,
                              const std::vector<GstBuffer*>& buffers) {
  {
    const Harness h = RecordingTo(path);
    gst_harness_set_src_caps_str(h.get(), caps);
    SetPlaying(h.get());
    for (GstBuffer* buffer : buffers) EXPECT_EQ(gst_harness_push(h.get(), buffer), GST_FLOW_OK);
    gst_harness_push_event(h.get(), gst_event_new_eos());
  }
  const auto played = Play("mcapsrc location=" + path + " ! fakesink name=see");
  EXPECT_EQ(played.error, "");
  const auto found = played.buffers.find("see");
  return found == played.buffers.end() ? std::vector<Kept>() : found->second;
}

GstBuffer* Bytes(const std::vector<std::uint8_t>& bytes, GstClockTime pts) {
  GstBuffer* buffer = gst_buffer_new_memdup(bytes.data(), bytes.size());
  GST_BUFFER_PTS(buffer) = pts;
  gst_lidar_buffer_set_capture_time(buffer, kCapture + pts);
  return buffer;
}

TEST_F(Mcap, SamplesOfAnImuComeBackOneByOne) {
  std::vector<std::uint8_t> packet;
  ByteWriter w(&packet);
  for (unsigned i = 0; i < 4; ++i) {
    w.Le64(kCapture + i * 10 * GST_MSECOND);
    for (unsigned k = 0; k < 6; ++k) w.LeF32(static_cast<float>(i) + 0.1F * static_cast<float>(k));
  }
  const gst::CapsPtr caps =
      gst::ImuCaps({1, 0, 0, 0.006, 0, 1, 0, -0.012, 0, 0, 1, 0.008, 0, 0, 0, 1});
  const gst::StringPtr text(gst_caps_to_string(caps.get()));
  const auto read = ThroughFile(Path("imu.mcap"), text.get(), {Bytes(packet, 0)});
  ASSERT_EQ(read.size(), 4U);
  std::string all;
  for (std::size_t i = 0; i < 4; ++i) {
    all += read[i].bytes;
    EXPECT_EQ(read[i].pts, i * 10 * GST_MSECOND);
    EXPECT_EQ(read[i].capture_time, kCapture + read[i].pts);
  }
  EXPECT_EQ(all, std::string(packet.begin(), packet.end()));
}

TEST_F(Mcap, PosesComeBackWithTheirTracking) {
  for (const GstLidarTracking tracking :
       {GST_LIDAR_TRACKING_OK, GST_LIDAR_TRACKING_DEGENERATE, GST_LIDAR_TRACKING_LOST}) {
    std::vector<std::uint8_t> pose;
    ByteWriter w(&pose);
    for (const double v : {1.5, -2.25, 0.125, 0.0, 0.6, 0.0, 0.8}) w.LeF64(v);
    w.Le64(tracking);
    const auto read = ThroughFile(Path("pose.mcap"), "application/x-odometry", {Bytes(pose, 0)});
    ASSERT_EQ(read.size(), 1U);
    const std::size_t covariance = tracking == GST_LIDAR_TRACKING_OK ? 0 : 36 * sizeof(double);
    ASSERT_EQ(read[0].bytes.size(), pose.size() + covariance) << "the recording tells them apart";
    EXPECT_EQ(read[0].bytes.substr(0, pose.size()), std::string(pose.begin(), pose.end()));
  }
}

TEST_F(Mcap, SlicesKeepTheirGapsAndDoNotInventATime) {
  const auto slice = [](guint8 byte, bool discont) {
    GstBuffer* buffer = gst_buffer_new_memdup(&byte, 1);
    GST_BUFFER_PTS(buffer) = byte * GST_MSECOND;
    if (discont) GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_DISCONT);
    return buffer;
  };
  const auto read = ThroughFile(Path("slices.mcap"), "application/x-lidar-slice,alignment=slice",
                                {slice(1, true), slice(2, false), slice(3, true), slice(4, false)});
  ASSERT_EQ(read.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(read[i].discont, i % 2 == 0) << i;
    EXPECT_EQ(read[i].capture_time, GST_CLOCK_TIME_NONE) << i;
  }
}

TEST_F(Mcap, BuffersOfAnotherSizeThanTheirCapsSayAreAnError) {
  const std::vector<std::uint8_t> bytes(33);
  for (const char* caps :
       {"application/x-imu,sample-size=32,"
        "fields=(string)\"t:U64:0,ax:F32:8,ay:F32:12,az:F32:16,gx:F32:20,gy:F32:24,gz:F32:28\"",
        "application/x-odometry",
        "application/x-pointcloud2,width=2,height=1,point-step=16,framerate=10/1,is-dense=true,"
        "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\""}) {
    const Harness h = RecordingTo(Path("bad.mcap"));
    gst_harness_set_src_caps_str(h.get(), caps);
    SetPlaying(h.get());
    EXPECT_EQ(gst_harness_push(h.get(), Bytes(bytes, 0)), GST_FLOW_ERROR) << caps;
  }
}

TEST_F(Mcap, EachStreamHasItsTopicAndItsPad) {
  const std::string sensor = kSensor + " num-buffers=16 ! ";
  const auto recorded = Play("mcapsink name=m" + At("a.mcap") + "sink_1::topic=/rear/slices " +
                             sensor + "lidarenc ! m. " + sensor + "lidarenc ! m. " + sensor +
                             "lidarenc ! m. " + sensor + "scanassembler ! m.");
  EXPECT_EQ(recorded.error, "");
  EXPECT_EQ(recorded.stats.at("messages"), 3 * 16 + 2U);
  for (const auto& [topic, count] : std::map<std::string, std::size_t>{
           {"/slices", 16}, {"/rear/slices", 16}, {"/slices_1", 16}, {"/points", 2}}) {
    const auto played = Play("mcapsrc topic=" + topic + At("a.mcap") + " ! fakesink name=see");
    EXPECT_EQ(played.error, "") << topic;
    EXPECT_EQ(played.buffers.at("see").size(), count) << topic;
  }
  const auto all = Play("mcapsrc name=s" + At("a.mcap") +
                        " s.src_0 ! queue ! fakesink name=see0 s.src_1 ! queue ! fakesink "
                        "name=see1 s.src_2 ! queue ! fakesink name=see2 s.src_3 ! queue ! fakesink "
                        "name=see3");
  EXPECT_EQ(all.error, "");
  std::size_t count = 0;
  for (const auto& [name, buffers] : all.buffers) count += buffers.size();
  EXPECT_EQ(count, 50U);
}

TEST_F(Mcap, ASparseStreamDoesNotHoldUpTheOthers) {
  {
    const Harness h = RecordingTo(Path("a.mcap"));
    GstHarness* late = gst_harness_new_with_element(h->element, "sink_1", nullptr);
    const Harness owner(late);
    gst_harness_set_src_caps_str(h.get(), "application/x-odometry");
    gst_harness_set_src_caps_str(late, "application/x-odometry");
    for (guint i = 0; i < 100; ++i)
      gst_harness_push(h.get(), Bytes(std::vector<std::uint8_t>(64, 1), i * 100 * GST_MSECOND));
    gst_harness_push(late, Bytes(std::vector<std::uint8_t>(64, 2), 9'900 * GST_MSECOND));
    gst_harness_push_event(h.get(), gst_event_new_eos());
    gst_harness_push_event(late, gst_event_new_eos());
  }
  // Without gap events, the sink of the stream that begins late would wait for ever. The queue
  // before the other sink would then fill up.
  const auto played = Play("mcapsrc name=m" + At("a.mcap") +
                           " m.src_0 ! queue max-size-buffers=10 ! fakesink name=see0 m.src_1 ! "
                           "queue ! fakesink name=see1");
  EXPECT_EQ(played.error, "");
  EXPECT_EQ(played.buffers.at("see0").size(), 100U);
  EXPECT_EQ(played.buffers.at("see1").size(), 1U);
}

TEST_F(Mcap, PadsGetNamesThatAreFree) {
  const gst::ElementPtr sink(gst_element_factory_make("mcapsink", nullptr));
  std::vector<gst::PadPtr> pads;
  std::set<std::string> names;
  for (const char* wanted : {"sink_1", "sink_%u", "sink_%u", "sink_7", "sink_%u"}) {
    pads.emplace_back(gst_element_request_pad_simple(sink.get(), wanted));
    ASSERT_TRUE(pads.back()) << wanted;
    names.insert(GST_OBJECT_NAME(pads.back().get()));
  }
  EXPECT_EQ(names.size(), pads.size());
  EXPECT_EQ(names.count("sink_1") + names.count("sink_7"), 2U);
  for (const gst::PadPtr& pad : pads) gst_element_release_request_pad(sink.get(), pad.get());
  EXPECT_EQ(GST_BIN_NUMCHILDREN(sink.get()), 0) << "streams go with their pads";
}

TEST_F(Mcap, APadMayGoWhileABufferWaitsInItsStream) {
  const gst::ElementPtr sink(gst_element_factory_make("mcapsink", nullptr));
  g_object_set(sink.get(), "location", Path("a.mcap").c_str(), nullptr);
  const gst::PadPtr pad(gst_element_request_pad_simple(sink.get(), "sink_0"));
  const gst::ElementPtr stream(gst_bin_get_by_name(GST_BIN(sink.get()), "sink_0"));
  ASSERT_NE(gst_element_set_state(sink.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  const gst::CapsPtr caps(gst_caps_from_string("application/x-odometry"));
  gst_pad_send_event(pad.get(), gst_event_new_stream_start("s"));
  gst_pad_send_event(pad.get(), gst_event_new_caps(caps.get()));
  gst_pad_send_event(pad.get(), NewSegment());
  std::thread waits([&] {
    GstBuffer* buffer = Bytes(std::vector<std::uint8_t>(64, 1), 0);
    EXPECT_EQ(gst_pad_chain(pad.get(), buffer), GST_FLOW_FLUSHING);
  });
  EXPECT_TRUE(Eventually([&] {
    GstSample* sample = nullptr;
    g_object_get(stream.get(), "last-sample", &sample, nullptr);
    const bool is_there = sample != nullptr;
    if (is_there) gst_sample_unref(sample);
    return is_there;
  }));
  std::atomic<bool> gone{false};
  std::thread goes([&] {
    gst_element_release_request_pad(sink.get(), pad.get());
    gone = true;
  });
  EXPECT_TRUE(Eventually([&] { return gone.load(); }));
  gst_element_set_state(sink.get(), GST_STATE_PLAYING);
  waits.join();
  goes.join();
  gst_element_set_state(sink.get(), GST_STATE_NULL);
}

TEST_F(Mcap, EndsWhenToldToAndPlaysTheNextTime) {
  Record(10, "", "a.mcap");
  Pipeline p("mcapsrc name=m" + At("a.mcap") +
             " ! fakesink name=see fakesrc num-buffers=1 ! fakesink");
  gst_element_set_state(p.get(), GST_STATE_PAUSED);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
  ASSERT_TRUE(gst_element_send_event(p.Find("m").get(), gst_event_new_eos()));
  EXPECT_EQ(p.Run().error, "");
  EXPECT_LE(p.outcome().buffers.at("see").size(), 3U);  // buffers that were already in the pipeline
  // The first message was not consumed, so it plays now.
  EXPECT_EQ(p.Run(GST_MESSAGE_ERROR).stats.at("messages"), 1U);
}

TEST_F(Mcap, CountsAnewAfterReady) {
  Record(2, "", "a.mcap");
  Pipeline p("mcapsrc name=m" + At("a.mcap") + " fakesrc num-buffers=1 ! fakesink");
  for (int round = 0; round < 2; ++round) {
    // Playing the first message fails, because the pad is not linked.
    EXPECT_EQ(p.Run(GST_MESSAGE_ERROR).stats.at("messages"), 1U);
  }
}

TEST_F(Mcap, PlaysAgainAfterReady) {
  const auto written = Record(2, "", "a.mcap");
  Pipeline p("mcapsrc" + At("a.mcap") + " ! fakesink name=see");
  for (int round = 0; round < 3; ++round) {
    p.Forget();
    gst_element_set_state(p.get(), GST_STATE_PLAYING);
    // Each start makes a new pad, but gst_parse_launch() links only the first one. Therefore only
    // the first round has buffers.
    ASSERT_TRUE(p.Wait(round == 0 ? GST_MESSAGE_EOS : GST_MESSAGE_ANY));
    if (round == 0) ExpectSame(p.outcome().buffers.at("see"), written);
    gst_element_set_state(p.get(), GST_STATE_READY);
  }
}

/// A fixture with a recording of another program. Its clouds have one layout, with big-endian
/// doubles.
class McapOfOthers : public Mcap {
 protected:
  void Record(const std::vector<cdr::PointCloud2>& clouds, const std::string& caps = "") {
    mcap::Catalogue catalogue;
    mcap::Channel channel;
    channel.schema_id = catalogue.AddSchema({0, "sensor_msgs/msg/PointCloud2", "ros2msg", ""});
    channel.topic = "/velodyne_points";
    channel.message_encoding = "cdr";
    if (!caps.empty()) channel.metadata = {{mcap::kCapsKey, caps}};
    const auto id = catalogue.AddChannel(channel);
    std::ofstream file(Path("other.mcap"), std::ios::binary);
    mcap::Writer writer({}, &catalogue, [&](ByteView v) {
      file.write(reinterpret_cast<const char*>(v.data), static_cast<std::streamsize>(v.size));
      return true;
    });
    for (const cdr::PointCloud2& cloud : clouds) {
      const auto message = cdr::WritePointCloud2(cloud);
      writer.Add({id, 0, kCapture, kCapture}, {message.data(), message.size()});
    }
    writer.Finish();
  }
  cdr::PointCloud2 Cloud(std::uint32_t width) const {
    cdr::PointCloud2 cloud;
    cloud.header = {Time(Duration(kCapture)), "velodyne"};
    cloud.layout = {1,    width, {{"x", 0, 8, 1}, {"y", 8, 8, 1}, {"z", 16, 8, 1}},
                    true, 24,    24 * width};
    return cloud;
  }
};

TEST_F(McapOfOthers, CloudsBecomeOurs) {
  std::vector<std::uint8_t> points;
  ByteWriter w(&points);
  for (const double v : {1.5, -2.0, 0.25, 4.0, 5.0, 6.0}) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &v, sizeof v);
    w.Be64(bits);
  }
  cdr::PointCloud2 cloud = Cloud(2);
  cloud.data = {points.data(), points.size()};
  // Empty clouds are not played, and neither is a cloud that claims to have more points than its
  // data.
  Record({Cloud(0), Cloud(0), Cloud(1U << 24), cloud});
  const auto played = Play("mcapsrc" + At("other.mcap") + " ! fakesink name=see");
  EXPECT_EQ(played.error, "");
  ASSERT_EQ(played.buffers.at("see").size(), 1U);
  const Kept& kept = played.buffers.at("see")[0];
  ASSERT_EQ(kept.bytes.size(), 24U);
  std::array<float, 6> read{};
  std::memcpy(read.data(), kept.bytes.data(), 24);
  EXPECT_EQ(read, (std::array<float, 6>{1.5F, -2, 0.25F, 4, 5, 6}));
  EXPECT_EQ(kept.capture_time, kCapture);
}

TEST_F(McapOfOthers, CloudsSayEachWhetherTheyAreDense) {
  const std::vector<std::uint8_t> points(48);
  cdr::PointCloud2 cloud = Cloud(2);
  cloud.data = {points.data(), points.size()};
  cdr::PointCloud2 dense = cloud;
  dense.is_dense = true;
  for (const bool ends_dense : {false, true}) {
    Record(ends_dense ? std::vector{cloud, dense} : std::vector{dense, cloud});
    const auto played = Play("mcapsrc" + At("other.mcap") + " ! fakesink name=see");
    EXPECT_EQ(played.buffers.at("see").size(), 2U);
    const std::string field = std::string("is-dense=(boolean)") + (ends_dense ? "true" : "false");
    EXPECT_NE(played.caps.at("see").find(field), std::string::npos) << played.caps.at("see");
  }
}

TEST_F(McapOfOthers, CloudsHaveTheFieldsOfTheirOwnMessages) {
  const std::vector<std::uint8_t> points(56);
  cdr::PointCloud2 cloud = Cloud(2);
  cloud.data = {points.data(), 48};
  cdr::PointCloud2 more = cloud;
  more.layout.fields.push_back({"intensity", 24, 7, 1});
  more.layout.point_step = 28;
  more.layout.row_step = 56;
  more.data = {points.data(), 56};
  Record({cloud, more});
  const auto played = Play("mcapsrc" + At("other.mcap") + " ! fakesink name=see");
  ASSERT_EQ(played.buffers.at("see").size(), 2U);
  EXPECT_NE(played.caps.at("see").find("intensity:F32"), std::string::npos)
      << played.caps.at("see");
}

/// Another program may have removed fields from our clouds, but copied the other metadata of the
/// channel.
TEST_F(McapOfOthers, CloudsOfAnotherLayoutThanTheRecordedCapsAreThoseOfTheirMessages) {
  const auto recorded = Play(kSensor + " num-buffers=1 slices-per-scan=1 ! fakesink name=see");
  const std::string ours = recorded.caps.at("see");
  ASSERT_NE(ours.find("sensor-model"), std::string::npos) << ours;
  const std::vector<std::uint8_t> points(48);
  cdr::PointCloud2 cloud = Cloud(2);
  cloud.data = {points.data(), points.size()};
  Record({cloud}, ours);
  const auto played = Play("mcapsrc" + At("other.mcap") + " ! fakesink name=see");
  EXPECT_EQ(played.error, "");
  ASSERT_EQ(played.buffers.at("see").size(), 1U);
  EXPECT_EQ(played.buffers.at("see")[0].bytes.size(), 24U);
  const std::string& caps = played.caps.at("see");
  for (const char* field : {"width=(int)2", "height=(int)1", "point-step=(int)12", "z:F32:8\""})
    EXPECT_NE(caps.find(field), std::string::npos) << caps;
  EXPECT_EQ(caps.find("sensor-model"), std::string::npos) << "it has 32 beams";
}

TEST_F(McapOfOthers, NoMorePadsComeOnceAllAreThere) {
  const std::vector<std::uint8_t> points(48);
  cdr::PointCloud2 cloud = Cloud(2);
  cloud.data = {points.data(), points.size()};
  Record({cloud, cloud});
  Pipeline p("mcapsrc name=m" + At("other.mcap") + " ! fakesink name=see");
  guint pads = 0;  // number of pads when the signal no-more-pads is emitted
  g_signal_connect(p.Find("m").get(), "no-more-pads",
                   G_CALLBACK(+[](GstElement* m, guint* n) { *n = m->numsrcpads; }), &pads);
  EXPECT_EQ(p.Run().error, "");
  EXPECT_EQ(pads, 1U);
}

TEST_F(Mcap, CloudsOfAnyWidthHaveOneChannel) {
  const auto recorded = Play(
      kSensor + " num-buffers=24 ! pointcloudfilter invalid=remove ! mcapsink" + At("clouds.mcap"));
  EXPECT_EQ(recorded.error, "");
  const std::string bytes = ReadFile(Path("clouds.mcap"));
  std::size_t channels =
      // The caps are in each channel record. There is one in the chunk, and one in the summary.
      0;
  for (std::size_t at = 0; (at = bytes.find("application/x-pointcloud2", at)) != std::string::npos;
       ++at)
    ++channels;
  EXPECT_LE(channels, 3U);
}

}  // namespace
}  // namespace lidar::test
