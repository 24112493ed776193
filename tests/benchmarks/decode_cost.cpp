// SPDX-License-Identifier: LGPL-2.1-or-later
// Searches for the slices that cost a decoder the most processor time per byte sent. It damages
// real slices, and slices whose points are all equal, at random. The slices with the highest cost
// are damaged again. Prints a line for each coder.
// usage: decode-cost [SECONDS]
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>

#include "ext/draco/slice_coder.h"
#include "src/codec/cloud/cloud_encoder.h"
#include "src/codec/cloud/exact_decoder.h"
#include "tests/benchmarks/capture_scans.h"

namespace lidar::bench {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::uint32_t kMaxPoints = 1U << 20;  // the largest number that lidardec accepts
constexpr std::size_t kKept = 32;
// The number of bytes that IP, UDP, RTP and the header of the slice's unit have together.
constexpr double kHeaders = 72;

double ProcessorTime() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Decodes a slice. A slice that is damaged may be refused.
using Decode = std::function<void(ByteView)>;

struct Slice {
  Bytes bytes;
  double cost_s = 0;
  double CostOfAByte() const { return cost_s / (kHeaders + static_cast<double>(bytes.size())); }
};

/// Measures the processor time that decoding takes. Returns the smallest of three times, because a
/// disturbance by another program can only make a time longer.
Slice Measure(const Decode& decode, Bytes bytes) {
  Slice slice{std::move(bytes), 1e9};
  for (int i = 0; i < 3; ++i) {
    const double begin = ProcessorTime();
    decode({slice.bytes.data(), slice.bytes.size()});
    slice.cost_s = std::min(slice.cost_s, ProcessorTime() - begin);
  }
  return slice;
}

Bytes Damaged(const Bytes& from, std::mt19937* random) {
  Bytes bytes = from;
  const auto any = [random](std::size_t n) { return (*random)() % n; };
  for (std::size_t n = 1 + any(3); n > 0; --n) {
    // Half of the changes are within the first 24 bytes. These contain headers, sizes and counts,
    // where a change has the largest effect on the cost.
    const std::size_t at =
        any(2) == 0 ? any(std::min<std::size_t>(bytes.size(), 24)) : any(bytes.size());
    constexpr std::uint8_t kEdges[] = {0, 1, 0x7F, 0x80, 0xFF};
    switch (any(4)) {
      case 0:
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 1U << any(8));
        break;
      case 1:
        bytes[at] = kEdges[any(std::size(kEdges))];
        break;
      case 2:
        bytes.resize(1 + any(bytes.size()));
        break;
      default:
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), 1 + any(3),
                     kEdges[any(std::size(kEdges))]);
    }
  }
  return bytes;
}

void Search(const char* coder, const std::vector<Bytes>& seeds, const Decode& decode,
            double seconds) {
  std::mt19937 random(1);
  std::vector<Slice> kept;
  double usual = 0;
  for (const Bytes& seed : seeds) {
    kept.push_back(Measure(decode, seed));
    usual = std::max(usual, kept.back().CostOfAByte());
  }
  const auto dearer = [](const Slice& a, const Slice& b) {
    return a.CostOfAByte() > b.CostOfAByte();
  };
  for (const double end = ProcessorTime() + seconds; ProcessorTime() < end;) {
    kept.push_back(Measure(decode, Damaged(kept[random() % kept.size()].bytes, &random)));
    if (kept.size() < 2 * kKept) continue;
    std::sort(kept.begin(), kept.end(), dearer);
    kept.resize(kKept);
  }
  const Slice worst = *std::min_element(kept.begin(), kept.end(), dearer);
  std::printf("%s: %.3f us a byte, at worst %.3f, a slice of %zu bytes in %.2f ms\n", coder,
              1e6 * usual, 1e6 * worst.CostOfAByte(), worst.bytes.size(), 1e3 * worst.cost_s);
  std::fflush(stdout);
}

/// Returns the slices of a capture, encoded with `geometry` and `coder`.
std::vector<Bytes> Code(const Capture& capture, Geometry geometry, codec::RangeCoder coder,
                        unsigned effort) {
  auto encoder = *draco::SliceEncoder::Create(capture.format, geometry, coder);
  encoder.set_effort(effort);
  draco::SliceSettings settings;
  settings.intensity_bits = 5;
  std::vector<Bytes> all;
  for (const CapturedSlice& slice : capture.slices) {
    codec::EncodedSlice encoded;
    encoder.Load({slice.points.data(), slice.points.size()}, slice.first_column, true);
    encoder.Encode(settings, &encoded);
    all.push_back(encoded.bytes);
  }
  return all;
}

std::vector<Bytes> CodeAsCloud(const Capture& capture, const codec::cloud::ExactChoice& exact) {
  auto encoder = *codec::cloud::CloudEncoder::Create(
      {capture.format.layout.fields, capture.format.layout.point_step}, exact);
  std::vector<Bytes> all;
  for (const CapturedSlice& slice : capture.slices) {
    codec::EncodedSlice encoded;
    encoder.Load({slice.points.data(), slice.points.size()}, true);
    encoder.Encode({0.02, 0, 5}, &encoded);
    all.push_back(encoded.bytes);
  }
  return all;
}

/// Returns a scan whose points are all equal to the first point of the capture. A coder encodes
/// such a scan in few bytes.
CapturedSlice Alike(const Capture& capture) {
  const codec::CloudFormat& format = capture.format;
  const std::vector<std::uint8_t>& points = capture.slices.front().points;
  const std::uint32_t step = format.layout.point_step;
  std::size_t first = 0;
  while (std::all_of(points.begin() + static_cast<std::ptrdiff_t>(first),
                     points.begin() + static_cast<std::ptrdiff_t>(first + step),
                     [](std::uint8_t b) { return b == 0; }))
    first += step;
  CapturedSlice slice;
  slice.width = format.sensor_model->columns_per_scan;
  for (std::size_t i = 0; i < std::size_t{slice.width} * format.height; ++i)
    slice.points.insert(slice.points.end(), points.begin() + static_cast<std::ptrdiff_t>(first),
                        points.begin() + static_cast<std::ptrdiff_t>(first + step));
  return slice;
}

int Run(double seconds) {
  const std::string folder = std::string(LIDAR_TEST_DATA) + "/ouster/";
  auto capture = ReadCapture(folder + "OS-1-128_v2.3.0_1024x10_lb_n3.pcap",
                             folder + "OS-1-128_v2.3.0_1024x10.json", 8);
  if (!capture) return 1;
  capture->slices.resize(8);
  capture->slices.push_back(Alike(*capture));
  const auto decode = [&](Geometry geometry) -> Decode {
    auto decoder = std::make_shared<draco::SliceDecoder>(capture->format, geometry, kMaxPoints);
    return [decoder](ByteView bytes) { decoder->Decode(bytes); };
  };
  using codec::RangeCoder;
  Search("lidarenc effort=0", Code(*capture, Geometry::kRange, RangeCoder::kAdaptive, 0),
         decode(Geometry::kRange), seconds);
  Search("lidarenc", Code(*capture, Geometry::kRange, RangeCoder::kMixing, 1),
         decode(Geometry::kRange), seconds);
  codec::cloud::ExactChoice exact;
  for (const char* coder : {"lidarenc geometry=xyz", "the same, fields and order"}) {
    codec::cloud::ExactDecoder cloud(exact.fields, kMaxPoints);
    Search(
        coder, CodeAsCloud(*capture, exact), [&cloud](ByteView bytes) { cloud.Decode(bytes); },
        seconds);
    exact = {{*capture->format.layout.fields.Find("range")}, true};
  }
  Search("dracoenc geometry=range", Code(*capture, Geometry::kRange, RangeCoder::kDraco, 0),
         decode(Geometry::kRange), seconds);
  Search("dracoenc geometry=xyz", Code(*capture, Geometry::kXyz, RangeCoder::kAdaptive, 0),
         decode(Geometry::kXyz), seconds);
  return 0;
}

}  // namespace
}  // namespace lidar::bench

int main(int argc, char** argv) { return lidar::bench::Run(argc > 1 ? std::atof(argv[1]) : 20); }
