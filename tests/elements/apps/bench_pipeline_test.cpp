// SPDX-License-Identifier: LGPL-2.1-or-later
// The part of scream-bench that runs a pipeline.
#include <gtest/gtest.h>

#include "src/tools/bench/scream_bench/pipeline.h"

namespace lidar::tools {
namespace {

constexpr std::chrono::microseconds kDuration{200'000};

TEST(BenchPipeline, CountsTheDurationFromPlaying) {
  const gst::ElementPtr pipeline(gst_parse_launch("fakesrc is-live=true ! fakesink", nullptr));
  gint64 playing_us = 0;
  gint64 end_us = 0;
  GstBus* bus = gst_element_get_bus(pipeline.get());
  gst_bus_set_sync_handler(
      bus,
      [](GstBus*, GstMessage* message, gpointer data) -> GstBusSyncReply {
        GstState state = GST_STATE_NULL;
        if (GST_MESSAGE_TYPE(message) != GST_MESSAGE_STATE_CHANGED) return GST_BUS_PASS;
        gst_message_parse_state_changed(message, nullptr, &state, nullptr);
        // The pipeline takes longer to start than it shall run.
        if (state == GST_STATE_READY) g_usleep(kDuration.count());
        if (state == GST_STATE_PLAYING) *static_cast<gint64*>(data) = g_get_monotonic_time();
        return GST_BUS_PASS;
      },
      &playing_us, nullptr);
  gst_object_unref(bus);
  const auto end = [&] {
    end_us = g_get_monotonic_time();
    gst_element_send_event(pipeline.get(), gst_event_new_eos());
  };
  EXPECT_EQ(RunPipeline(
                pipeline.get(), "test", kDuration, [] {}, end),
            0);
  EXPECT_GE(end_us - playing_us, kDuration.count());
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
}

}  // namespace
}  // namespace lidar::tools
