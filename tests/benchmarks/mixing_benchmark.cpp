// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures size and speed of the mixing coder on real scans, in one thread.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "src/codec/cloud_io.h"
#include "src/codec/mixing/mixing_codec.h"
#include "tests/benchmarks/capture_scans.h"

namespace lidar::bench {
namespace {

struct Source {
  const char* name;
  const char* pcap;
  const char* metadata;
};
constexpr Source kSources[] = {
    {"OS0-32", "OS-0-32-U1_v2.2.0_1024x10.pcap", "OS-0-32-U1_v2.2.0_1024x10.json"},
    {"OS1-128-lb_n3", "OS-1-128_v2.3.0_1024x10_lb_n3.pcap", "OS-1-128_v2.3.0_1024x10.json"}};
// The size of the header in front of a block's payload.
constexpr double kHeaderBytes = 12;

/// The arguments of a benchmark are: source, slices per scan, effort, error [mm], intensity bits.
struct Setup {
  explicit Setup(const benchmark::State& state) {
    const Source& source = kSources[state.range(0)];
    const std::string folder = std::string(LIDAR_TEST_DATA) + "/ouster/";
    const auto capture = ReadCapture(folder + source.pcap, folder + source.metadata,
                                     static_cast<std::uint32_t>(state.range(1)));
    if (!capture || capture->slices.empty()) std::abort();
    sensor = *capture->format.sensor_model;
    for (const CapturedSlice& slice : capture->slices) {
      codec::RangeImage image;
      image.beams = capture->format.height;
      image.columns = slice.width;
      codec::ReadRangeImage({slice.points.data(), slice.points.size()}, capture->format.layout,
                            true, &image);
      for (const std::uint32_t range : image.ranges) returns += range != 0 ? 1 : 0;
      images.push_back(std::move(image));
    }
    settings.effort = static_cast<unsigned>(state.range(2));
    settings.grid =
        RangeGrid::ForError(1e-3 * static_cast<double>(state.range(3)), sensor.range_unit_mm);
    settings.intensity =
        codec::IntensityScale(codec::FullScale::kByte, static_cast<unsigned>(state.range(4)));
  }
  SensorModel sensor;
  std::vector<codec::RangeImage> images;
  codec::MixingSettings settings;
  double returns = 0;
};

void Report(const Setup& setup, double bytes, benchmark::State* state) {
  bytes += kHeaderBytes * static_cast<double>(setup.images.size());
  state->SetLabel(kSources[state->range(0)].name);
  state->counters["returns/s"] =
      benchmark::Counter(setup.returns, benchmark::Counter::kIsIterationInvariantRate);
  state->counters["bits/return"] = 8 * bytes / setup.returns;
}

void EncodeMixing(benchmark::State& state) {
  const Setup setup(state);
  codec::MixingEncoder encoder(setup.sensor);
  double bytes = 0;
  for (auto _ : state) {
    bytes = 0;
    for (const codec::RangeImage& image : setup.images) {
      std::vector<std::uint8_t> payload;
      if (!encoder.Encode(image, setup.settings, &payload)) std::abort();
      bytes += static_cast<double>(payload.size());
    }
  }
  Report(setup, bytes, &state);
}

void DecodeMixing(benchmark::State& state) {
  const Setup setup(state);
  codec::MixingEncoder encoder(setup.sensor);
  std::vector<std::vector<std::uint8_t>> payloads(setup.images.size());
  double bytes = 0;
  for (std::size_t i = 0; i < payloads.size(); ++i) {
    if (!encoder.Encode(setup.images[i], setup.settings, &payloads[i])) std::abort();
    bytes += static_cast<double>(payloads[i].size());
  }
  codec::MixingDecoder decoder(setup.sensor);
  codec::RangeImage image = setup.images[0];
  for (auto _ : state)
    for (const auto& payload : payloads)
      if (!decoder.Decode({payload.data(), payload.size()}, setup.settings.grid,
                          setup.settings.intensity.bits(), &image)) {
        std::abort();
      }
  Report(setup, bytes, &state);
}

void Cases(benchmark::internal::Benchmark* b) {
  b->ArgNames({"source", "slices", "effort", "error_mm", "intensity"});
  for (const int source : {0, 1})
    for (const int effort : {1, 2, 3})
      for (const int error : {20, 50}) b->Args({source, 8, effort, error, 0});
  for (const int source : {0, 1}) {
    b->Args({source, 1, 2, 20, 0});
    b->Args({source, 8, 2, 20, 5});
  }
  b->Unit(benchmark::kMillisecond);
}

BENCHMARK(EncodeMixing)->Apply(Cases);
BENCHMARK(DecodeMixing)->Apply(Cases);

}  // namespace
}  // namespace lidar::bench

BENCHMARK_MAIN();
