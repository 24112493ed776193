// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures size and speed of the range codec and of the xyz codec on real scans. Each benchmark
// uses one thread unless its name says otherwise.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <map>

#include "ext/draco/slice_coder.h"
#include "tests/benchmarks/capture_scans.h"

namespace lidar::bench {
namespace {

struct Source {
  const char* pcap;
  const char* metadata;
};
constexpr Source kSources[] = {
    {"OS-0-32-U1_v2.2.0_1024x10.pcap", "OS-0-32-U1_v2.2.0_1024x10.json"},
    {"OS-1-128_v2.3.0_1024x10_lb_n3.pcap", "OS-1-128_v2.3.0_1024x10.json"},
    {"OS-0-128-U1_v2.3.0_1024x10.pcap", "OS-0-128-U1_v2.3.0_1024x10.json"},
    {"OS-1-32-G_v2.1.1_1024x10.pcap", "OS-1-32-G_v2.1.1_1024x10.json"}};
constexpr const char* kNames[] = {"OS0-32", "OS1-128-lb_n3", "OS0-128", "OS1-32"};

const Capture& CaptureOf(std::int64_t source, std::int64_t slices) {
  static std::map<std::pair<std::int64_t, std::int64_t>, Capture> captures;
  const auto found = captures.find({source, slices});
  if (found != captures.end()) return found->second;
  const std::string folder = std::string(LIDAR_TEST_DATA) + "/ouster/";
  auto capture = ReadCapture(folder + kSources[source].pcap, folder + kSources[source].metadata,
                             static_cast<std::uint32_t>(slices));
  if (!capture || capture->slices.empty()) std::abort();
  return captures[{source, slices}] = *std::move(capture);
}

// The argument `coder` of a benchmark is the number of a codec::RangeCoder. For the mixing coder it
// is kEffort plus the effort.
constexpr std::int64_t kEffort = 10;

codec::RangeCoder CoderOf(std::int64_t coder) {
  return coder > kEffort ? codec::RangeCoder::kMixing : static_cast<codec::RangeCoder>(coder);
}

/// The arguments of a benchmark of the range codec are: source, slices per scan, coder, error [mm],
/// intensity bits.
struct Setup {
  explicit Setup(const benchmark::State& state, Geometry geometry)
      : capture(CaptureOf(state.range(0), state.range(1))),
        encoder(*draco::SliceEncoder::Create(capture.format, geometry, CoderOf(state.range(2)))) {
    if (state.range(2) > kEffort)
      encoder.set_effort(static_cast<unsigned>(state.range(2) - kEffort));
    settings.level = static_cast<unsigned>(state.range(2));
    settings.max_error_m = 1e-3 * static_cast<double>(state.range(3));
    settings.intensity_bits = static_cast<unsigned>(state.range(4));
  }
  codec::EncodedSlice EncodeSlice(const CapturedSlice& slice) {
    codec::EncodedSlice encoded;
    encoder.Load({slice.points.data(), slice.points.size()}, slice.first_column,
                 settings.intensity_bits > 0);
    encoder.Encode(settings, &encoded);
    return encoded;
  }
  const Capture& capture;
  draco::SliceEncoder encoder;
  draco::SliceSettings settings;
};

void Report(benchmark::State& state, double returns, double bytes) {
  state.SetLabel(kNames[state.range(0)]);
  state.counters["returns/s"] =
      benchmark::Counter(returns, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bits/return"] = 8 * bytes / returns;
}

void EncodeAll(Setup* setup, benchmark::State& state) {
  double returns = 0;
  double bytes = 0;
  for (auto _ : state) {
    returns = bytes = 0;
    for (const CapturedSlice& slice : setup->capture.slices) {
      const auto encoded = setup->EncodeSlice(slice);
      returns += static_cast<double>(encoded.returns);
      bytes += static_cast<double>(encoded.bytes.size());
    }
  }
  Report(state, returns, bytes);
}

void Encode(benchmark::State& state, Geometry geometry) {
  Setup setup(state, geometry);
  EncodeAll(&setup, state);
}

/// Encodes whole scans with several threads. The benchmark uses wall-clock time, because CPU time
/// would not become shorter when threads share the work.
void EncodeWithThreads(benchmark::State& state) {
  Setup setup(state, Geometry::kRange);
  setup.encoder.set_threads(static_cast<unsigned>(state.range(5)));
  EncodeAll(&setup, state);
}

void Decode(benchmark::State& state, Geometry geometry) {
  Setup setup(state, geometry);
  std::vector<codec::EncodedSlice> slices;
  double returns = 0;
  double bytes = 0;
  for (const CapturedSlice& slice : setup.capture.slices) {
    slices.push_back(setup.EncodeSlice(slice));
    returns += static_cast<double>(slices.back().returns);
    bytes += static_cast<double>(slices.back().bytes.size());
  }
  codec::CloudFormat format = setup.capture.format;
  format.layout.fields = codec::KeptFields(format.layout.fields, setup.settings.intensity_bits > 0,
                                           geometry == Geometry::kRange);
  format.layout.point_step = format.layout.fields.MinimumStep();
  draco::SliceDecoder decoder(format, geometry, 1U << 20);
  std::vector<std::uint8_t> raw;
  for (auto _ : state) {
    for (const auto& slice : slices) {
      const auto shape = decoder.Decode({slice.bytes.data(), slice.bytes.size()});
      if (!shape) std::abort();
      raw.resize(std::size_t{shape->width} * shape->height * format.layout.point_step);
      decoder.Write(raw.data());
    }
  }
  Report(state, returns, bytes);
}

void RangeCases(benchmark::internal::Benchmark* b) {
  b->ArgNames({"source", "slices", "coder", "error_mm", "intensity"});
  for (const int coder : {1, 2, 3, 11, 12, 13})
    for (const int source : {0, 1})
      for (const int slices : {1, 8}) b->Args({source, slices, coder, 20, 0});
  for (const int source : {0, 1})
    for (const int slices : {1, 8})
      for (const int bits : {5, 8}) b->Args({source, slices, 3, 20, bits});
  for (const int coder : {11, 12, 13}) b->Args({1, 8, coder, 20, 5});
  for (const int error : {1, 5, 10, 50}) b->Args({1, 8, 3, error, 0});
  for (const int source : {2, 3}) b->Args({source, 8, 3, 20, 0});
  b->Unit(benchmark::kMillisecond);
}

void XyzCases(benchmark::internal::Benchmark* b) {
  b->ArgNames({"source", "slices", "level", "error_mm", "intensity"});
  // Level 0 is Draco's sequential coder. Each other level is one of the four modes of its kd-tree
  // coder.
  for (const int level : {0, 1, 3, 5, 7})
    for (const int slices : {1, 8}) b->Args({1, slices, level, 20, 0});
  for (const int level : {0, 7}) b->Args({0, 1, level, 20, 0});
  for (const int level : {0, 1, 5, 7}) b->Args({1, 1, level, 20, 5});
  b->Unit(benchmark::kMillisecond);
}

void ThreadCases(benchmark::internal::Benchmark* b) {
  b->ArgNames({"source", "slices", "coder", "error_mm", "intensity", "threads"});
  for (const int bits : {0, 5})
    for (const int threads : {1, 2, 4}) b->Args({1, 1, 3, 20, bits, threads});
  b->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
}

BENCHMARK(EncodeWithThreads)->Apply(ThreadCases);
BENCHMARK_CAPTURE(Encode, range, Geometry::kRange)->Apply(RangeCases);
BENCHMARK_CAPTURE(Decode, range, Geometry::kRange)->Apply(RangeCases);
BENCHMARK_CAPTURE(Encode, xyz, Geometry::kXyz)->Apply(XyzCases);
BENCHMARK_CAPTURE(Decode, xyz, Geometry::kXyz)->Apply(XyzCases);

}  // namespace
}  // namespace lidar::bench

BENCHMARK_MAIN();
