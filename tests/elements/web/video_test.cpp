// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of a camera's video: a client gets frames from a key frame on, with the times at which they
// were captured.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/elements/web/web_peer.h"
#include "tests/support/proto_reader.h"

namespace lidar::test {
namespace {

constexpr const char* kH264 = "video/x-h264,stream-format=byte-stream,alignment=au";
constexpr GstClockTime kPictureTime_ns = 1'700'000'000'000'000'007;

struct Frame {
  explicit Frame(const Received& received) : unix_ns(received.unix_ns) {
    const ProtoMessage message(
        {reinterpret_cast<const std::uint8_t*>(received.payload.data()), received.payload.size()});
    EXPECT_TRUE(message.whole());
    data = message.Text(3);
    format = message.Text(4);
    frame_id = message.Text(2);
  }
  std::uint64_t unix_ns = 0;
  std::string data;
  std::string format;
  std::string frame_id;
};

gst::BufferPtr FrameOf(const std::string& data, bool is_key) {
  gst::BufferPtr buffer(gst_buffer_new_memdup(data.data(), data.size()));
  if (!is_key) GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_DELTA_UNIT);
  return buffer;
}

TEST(Camera, IsCompressedVideoOfTheTimeOfItsCapture) {
  Sink sink("sink_0::frame-id=front");
  gst_harness_set_src_caps_str(sink.harness(), kH264);
  Peer peer(&sink);
  peer.Subscribe("/camera", 4);
  EXPECT_EQ(peer.channels["/camera"]["schemaName"], "foxglove.CompressedVideo");
  gst::BufferPtr buffer = FrameOf("key", true);
  gst_lidar_buffer_set_capture_time(buffer.get(), kPictureTime_ns);
  ASSERT_EQ(gst_harness_push(sink.harness(), buffer.release()), GST_FLOW_OK);
  const Frame frame(peer.Next());
  EXPECT_EQ(frame.unix_ns, kPictureTime_ns);
  EXPECT_EQ(frame.data, "key");
  EXPECT_EQ(frame.format, "h264");
  EXPECT_EQ(frame.frame_id, "front");
}

TEST(Camera, BeginsForEachViewerWithAKeyFrame) {
  Sink sink;
  gst_harness_set_src_caps_str(sink.harness(), "video/x-vp8");
  Peer peer(&sink);
  peer.Subscribe("/camera", 4);
  const auto push = [&](const std::string& data, bool is_key) {
    ASSERT_EQ(gst_harness_push(sink.harness(), FrameOf(data, is_key).release()), GST_FLOW_OK);
  };
  push("delta of nothing", false);
  push("key", true);
  push("delta", false);
  EXPECT_EQ(Frame(peer.Next()).data, "key");
  EXPECT_EQ(Frame(peer.Next()).data, "delta");
  Peer late(&sink);
  late.Subscribe("/camera", 5);
  push("delta 2", false);
  push("key 2", true);
  EXPECT_EQ(Frame(late.Next()).data, "key 2");
  EXPECT_EQ(Frame(peer.Next()).data, "delta 2");
}

TEST(Camera, WithoutCaptureTimesHasThatOfItsTimestamp) {
  Sink sink;
  gst_harness_use_testclock(sink.harness());
  gst_harness_set_src_caps_str(sink.harness(), kH264);
  Peer peer(&sink);
  peer.Subscribe("/camera", 4);
  const auto unix_now = [] { return static_cast<guint64>(g_get_real_time()) * GST_USECOND; };
  // The input is a child element, and it handles the buffers. In a pipeline both would have the
  // same base time.
  auto* input = GST_ELEMENT(GST_BIN_CHILDREN(sink.element())->data);
  constexpr GstClockTime kSecond = GST_SECOND;
  gst_harness_set_time(sink.harness(), 100 * kSecond);
  for (const guint base : {0U, 30U}) {
    gst_element_set_base_time(input, base * kSecond);
    for (const guint pts : {10U, 50U, 90U}) {
      gst::BufferPtr buffer = FrameOf("key", true);
      GST_BUFFER_PTS(buffer.get()) = pts * kSecond;
      const guint64 before = unix_now();
      gst_harness_push(sink.harness(), buffer.release());
      const guint64 shown = Frame(peer.Next()).unix_ns;
      // If the timestamp is in the future, the current time replaces it.
      const guint64 age = (100 - std::min(base + pts, 100U)) * kSecond;
      EXPECT_GE(shown + age, before);
      EXPECT_LE(shown + age, unix_now());
    }
  }
}

TEST(Camera, RefusesWhatViewersCannotRead) {
  Sink sink;
  gst_harness_set_src_caps_str(sink.harness(), "video/x-h264,stream-format=avc,alignment=au");
  EXPECT_EQ(gst_harness_push(sink.harness(), FrameOf("key", true).release()),
            GST_FLOW_NOT_NEGOTIATED);
}

struct Coder {
  const char* name;
  const char* elements;
  const char* format;
  bool (*is_key)(const std::string& frame);
};
class StockCoder : public ::testing::TestWithParam<Coder> {};
TEST_P(StockCoder, IsShown) {
  const std::string text =
      std::string(
          "videotestsrc is-live=true ! video/x-raw,width=160,height=120,framerate=30/1 ! ") +
      GetParam().elements + " ! foxglovesink name=web port=0";
  GError* error = nullptr;
  const gst::ElementPtr pipeline(gst_parse_launch(text.c_str(), &error));
  if (error != nullptr) {
    const std::string why = error->message;
    g_error_free(error);
    GTEST_SKIP() << why;
  }
  const gst::ElementPtr web(gst_bin_get_by_name(GST_BIN(pipeline.get()), "web"));
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  {
    Peer peer("ws://127.0.0.1:" + std::to_string(StatOf(web.get(), "port")), {"foxglove.sdk.v1"});
    peer.Subscribe("/camera", 4);
    std::uint64_t before = 0;
    for (int i = 0; i < 5; ++i) {
      const Frame frame(peer.Next());
      EXPECT_EQ(frame.format, GetParam().format);
      if (i == 0) {
        EXPECT_TRUE(GetParam().is_key(frame.data));
      }
      EXPECT_GT(frame.unix_ns, before);
      before = frame.unix_ns;
    }
    EXPECT_LE(before, static_cast<std::uint64_t>(g_get_real_time()) * 1000);
  }
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
}
/// Returns true if `frame` is in Annex B format and has its parameter sets before the picture.
bool BeginsWithSps(const std::string& frame) {
  const std::size_t sps = frame.find(std::string("\0\0\1\x67", 4));
  return sps != std::string::npos && sps < frame.find(std::string("\0\0\1\x65", 4));
}
INSTANTIATE_TEST_SUITE_P(
    All, StockCoder,
    ::testing::Values(Coder{"openh264", "openh264enc gop-size=10 ! h264parse", "h264",
                            BeginsWithSps},
                      Coder{"vp8", "vp8enc deadline=1 keyframe-max-dist=10", "vp8",
                            [](const std::string& frame) { return (frame[0] & 1) == 0; }},
                      Coder{"over_rtp",
                            "openh264enc gop-size=10 ! rtph264pay config-interval=-1 ! "
                            "rtph264depay ! h264parse",
                            "h264", BeginsWithSps}),
    [](const auto& c) { return std::string(c.param.name); });

}  // namespace
}  // namespace lidar::test
