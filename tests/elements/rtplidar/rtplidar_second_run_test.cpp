// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that a payloader or depayloader that was stopped or flushed behaves like a new one.
#include <gtest/gtest.h>

#include "tests/elements/rtplidar/slices.h"
#include "tests/support/run_trace.h"

namespace lidar::test {
namespace {

void Give(GstHarness* h, GstBuffer* buffer) { gst_pad_push(h->srcpad, buffer); }

/// Pushes bitrate bounds and slices, of which one is empty. The last aggregate stays incomplete.
void PayRun(GstHarness* h) {
  const GstLidarBitrateBounds bounds{1'000, 2'000, 3'000};
  gst_pad_push_event(h->srcpad, gst_lidar_event_new_bitrate_bounds(&bounds));
  for (guint scan = 0; scan < 12; ++scan)
    for (guint i = 0; i < kSlices; ++i) Give(h, EncodedSlice(scan, i, 200 + 100 * i));
  Give(h, EncodedSlice(12, 0, 0));
  Give(h, EncodedSlice(13, 0, 150));
}

class PaySecondRun : public ::testing::TestWithParam<bool> {
 protected:
  PaySecondRun() {
    g_object_set(h_->element, "aggregate", GetParam(), nullptr);
    trace_.Take();
  }

  Harness h_{gst_harness_new("rtplidarpay")};
  // False: without bytes, because sequence numbers begin at random.
  RunTrace trace_{h_.get(), false};
};

TEST_P(PaySecondRun, IsAsTheFirst) {
  Lines first;
  for (int run = 0; run < 2; ++run) {
    trace_.Begin(EncodedCaps());
    PayRun(h_.get());
    Lines lines = trace_.Take();
    // The statistics and the SSRC contain random numbers.
    if (lines.back().rfind("stats", 0) == 0) lines.pop_back();
    for (std::string& line : lines)
      if (line.rfind("event caps", 0) == 0) line.resize(line.find("ssrc"));
    for (const char* name : {"scans-sent", "slices-sent", "packets-sent", "configs-sent",
                             "slice-bytes", "payload-bytes", "empty-dropped"}) {
      lines.push_back(name + std::string(" ") + std::to_string(Stat(h_.get(), name)));
      EXPECT_GT(Stat(h_.get(), name), 0U) << name;
    }
    if (run == 0) first = lines;
    EXPECT_EQ(lines, first);
    trace_.Stop();
    trace_.Take();
  }
}

TEST_P(PaySecondRun, BeginsWithTheConfigBehindAFlush) {
  trace_.Begin(EncodedCaps());
  PayRun(h_.get());
  trace_.Flush();
  PullAll(h_.get());
  Give(h_.get(), EncodedSlice(14, kSlices - 1, 200));
  const auto packets = PullAll(h_.get());
  ASSERT_EQ(packets.size(), 2U);
  EXPECT_TRUE(packets[0].IsConfig());
  EXPECT_FALSE(packets[1].IsConfig());
}

INSTANTIATE_TEST_SUITE_P(AloneAndTogether, PaySecondRun, ::testing::Bool());

/// A fixture whose Run() pushes garbage, packets with another payload type, packets of another
/// sender, and a stream with losses. The last slice stays incomplete.
class DepaySecondRun : public ::testing::Test {
 protected:
  void Run() {
    for (const char* garbage : {"x", "no RTP"})
      Give(h_.get(), gst_buffer_new_memdup(garbage, strlen(garbage)));
    for (const auto& packet : wrong_type_) Give(h_.get(), gst_buffer_copy_deep(packet.get()));
    for (std::size_t i = 0; i + 1 < packets_.size(); ++i) {
      if (i % 17 == 9) continue;
      Give(h_.get(), gst_buffer_copy_deep(packets_[i].get()));
      if (i % 13 == 5) Give(h_.get(), gst_buffer_copy_deep(packets_[i].get()));
      if (i < rivals_.size()) Give(h_.get(), gst_buffer_copy_deep(rivals_[i].get()));
    }
  }

  const std::vector<gst::BufferPtr> packets_ = Packets(50);
  const std::vector<gst::BufferPtr> rivals_ = Packets(45);
  const std::vector<gst::BufferPtr> wrong_type_ = WithType(Packets(6), 111);
  Harness h_{gst_harness_new("rtplidardepay")};
  RunTrace trace_{h_.get()};
};

TEST_F(DepaySecondRun, IsAsTheFirst) {
  Lines first;
  for (int run = 0; run < 2; ++run) {
    trace_.Begin(kRtpCaps);
    Run();
    const Lines lines = trace_.Take();
    const auto warnings = std::count_if(lines.begin(), lines.end(), [](const auto& line) {
      return line.rfind("message warning", 0) == 0;
    });
    EXPECT_EQ(warnings, 2);  // one for the payload type, one for the other sender
    if (run == 0) first = lines;
    EXPECT_EQ(lines, first);
    trace_.Stop();
    trace_.Take();
  }
}

TEST_F(DepaySecondRun, GivesTheSameSlicesBehindAFlush) {
  trace_.Begin(kRtpCaps);
  Run();
  const Lines first = trace_.TakeBuffers();
  trace_.Flush();
  trace_.Take();
  Run();
  EXPECT_EQ(trace_.TakeBuffers(), first);
}

TEST_F(DepaySecondRun, CountsWhatWasUnderWayAtTheStop) {
  trace_.Begin(kRtpCaps);
  Run();
  const guint64 incomplete = Stat(h_.get(), "scans-incomplete");
  trace_.Stop();
  EXPECT_EQ(Stat(h_.get(), "scans-incomplete"), incomplete + 1);
}

TEST_F(DepaySecondRun, TakesNothingBeforeItsCaps) {
  for (int run = 0; run < 2; ++run) {
    for (const bool active : {false, true}) gst_pad_set_active(h_->srcpad, active);
    gst_harness_play(h_.get());
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start("run"));
    trace_.PushSegment();
    GstBuffer* of_other_type = gst_buffer_copy_deep(wrong_type_[0].get());
    EXPECT_EQ(gst_pad_push(h_->srcpad, of_other_type), GST_FLOW_NOT_NEGOTIATED) << run;
    trace_.PushCaps(kRtpCaps);
    trace_.Stop();
  }
}

TEST_F(DepaySecondRun, CountsEachPacketThatIsNoRtp) {
  trace_.Begin(kRtpCaps);
  for (int i = 0; i < 3; ++i) Give(h_.get(), gst_buffer_new_memdup("x", 1));
  EXPECT_EQ(Stat(h_.get(), "packets-invalid"), 3U);
}

TEST_F(DepaySecondRun, CountsTheSlicesThatNobodyTakesAnew) {
  for (int run = 0; run < 2; ++run) {
    gst_harness_set_sink_caps_str(h_.get(), "application/x-other");
    trace_.Begin(kRtpCaps);
    for (const auto& packet : packets_) Give(h_.get(), gst_buffer_copy_deep(packet.get()));
    EXPECT_EQ(Stat(h_.get(), "slices-not-accepted"), 200U) << run;
    trace_.Stop();
  }
}

}  // namespace
}  // namespace lidar::test
