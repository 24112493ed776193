// SPDX-License-Identifier: LGPL-2.1-or-later
// Speed of the coders as elements, from buffer to buffer, one thread.
#include <benchmark/benchmark.h>
#include <gst/check/gstharness.h>

#include <cstdlib>

#include "gst/common/refs.h"
#include "gst/lidar/cloud_info.h"
#include "tests/benchmarks/capture_scans.h"

namespace lidar::bench {
namespace {

gst::CapsPtr CapsOf(const Capture& capture) {
  gst::CloudInfo info;
  info.fields = capture.format.layout.fields;
  info.point_step = capture.format.layout.point_step;
  info.width = capture.slices[0].width;
  info.height = capture.format.height;
  info.framerate_n = 10;
  info.sensor_model = capture.format.sensor_model;
  return gst::CapsPtr(info.ToCaps());
}

double Returns(const Capture& capture) {
  double returns = 0;
  for (const CapturedSlice& slice : capture.slices) {
    for (std::size_t at = 0; at < slice.points.size(); at += capture.format.layout.point_step) {
      float x = 0;
      std::memcpy(&x, &slice.points[at], sizeof x);
      returns += x != 0 ? 1 : 0;
    }
  }
  return returns;
}

/// Range arguments: slices a scan, intensity bits, and whether to decode.
void Elements(benchmark::State& state, const char* encoder, const char* decoder) {
  gst_init(nullptr, nullptr);
  const std::string folder = std::string(LIDAR_TEST_DATA) + "/ouster/";
  const auto capture = ReadCapture(folder + "OS-1-128_v2.3.0_1024x10_lb_n3.pcap",
                                   folder + "OS-1-128_v2.3.0_1024x10.json",
                                   static_cast<std::uint32_t>(state.range(0)));
  if (!capture || capture->slices.empty()) std::abort();
  const std::string text = std::string(encoder) +
                           " intensity-bits=" + std::to_string(state.range(1)) +
                           (state.range(2) != 0 ? std::string(" ! ") + decoder : "");
  GstHarness* h = gst_harness_new_parse(text.c_str());
  gst_harness_set_drop_buffers(h, TRUE);
  gst_harness_set_src_caps(h, CapsOf(*capture).release());
  std::vector<gst::BufferPtr> buffers;
  guint count = 0;
  for (const CapturedSlice& slice : capture->slices) {
    GstBuffer* buffer = gst_buffer_new_memdup(slice.points.data(), slice.points.size());
    const guint slices = static_cast<guint>(state.range(0));
    const GstLidarSlice place{count / slices, count % slices, slices, slice.first_column};
    gst_lidar_buffer_set_slice(buffer, &place);
    buffers.emplace_back(buffer);
    ++count;
  }
  for (auto _ : state)
    for (const auto& buffer : buffers) gst_harness_push(h, gst_buffer_ref(buffer.get()));
  state.counters["returns/s"] =
      benchmark::Counter(Returns(*capture), benchmark::Counter::kIsIterationInvariantRate);
  gst_harness_teardown(h);
}

void Arguments(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"slices", "intensity", "decode"})
      ->Args({1, 0, 0})
      ->Args({8, 0, 0})
      ->Args({8, 5, 0})
      ->Args({8, 0, 1})
      ->Args({8, 5, 1})
      ->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(Elements, lidarenc, "lidarenc", "lidardec")->Apply(Arguments);
BENCHMARK_CAPTURE(Elements, dracoenc, "dracoenc", "dracodec")->Apply(Arguments);

}  // namespace
}  // namespace lidar::bench

BENCHMARK_MAIN();
