// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-eval clouds: encodes clouds without a sensor model, by our coder and by Draco.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>
#include <random>

#include "src/cloud/nearest_point.h"
#include "src/codec/cloud/cloud_decoder.h"
#include "src/codec/cloud/cloud_encoder.h"
#include "src/tools/lab/codec_lab/measure.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "src/tools/lab/lidar_eval/commands.h"

namespace lidar::tools {
namespace {

struct CloudsOptions {
  std::vector<std::string> sources;
  SourceOptions source;
  std::vector<double> errors = {0.02, 0.05};
  std::vector<unsigned> efforts = {0, 1, 2, 3};
  unsigned repeats = 1;
  bool shuffle = false;
};

/// Sums over all scans of a source at one setting of the coder.
struct CloudCost {
  std::size_t points = 0;
  std::size_t bytes = 0;
  double largest_error_m = 0;
  double encode_s = 0;
  double decode_s = 0;
};

double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Returns the largest distance from a point of one cloud to the nearest point of the other cloud,
/// in both directions.
double LargestGap(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    const NearestPoint nearest(*to);
    for (std::size_t i = 0; i + 2 < from->size(); i += 3)
      largest = std::max(largest, nearest.DistanceFrom(&(*from)[i]));
  }
  return largest;
}

/// Returns the points of a scan as a driver publishes them: column by column, only returns, and
/// without ranges.
std::vector<float> PointsOf(const Scan& scan) {
  const RangeProjection& projection = scan.geometry->projection;
  std::vector<float> xyz;
  for (std::uint32_t column = 0; column < projection.columns(); ++column)
    for (std::uint32_t beam = 0; beam < projection.beams(); ++beam) {
      const std::uint32_t range = scan.ranges[std::size_t{beam} * projection.columns() + column];
      if (range == 0) continue;
      const auto point = projection.Point(beam, column, range);
      xyz.insert(xyz.end(), point.begin(), point.end());
    }
  return xyz;
}

/// Replaces organised scans by their points. These have no ranges and no sensor model.
void Flatten(ScanSet* set) {
  for (Scan& scan : set->scans) {
    if (!scan.organised()) continue;
    Scan flat;
    flat.xyz = PointsOf(scan);
    scan = std::move(flat);
  }
}

void Shuffle(Scan* scan) {
  std::mt19937 random(1);
  for (std::size_t i = scan->xyz.size() / 3; i > 1; --i) {
    const std::size_t other = random() % i;
    std::swap_ranges(&scan->xyz[3 * (i - 1)], &scan->xyz[3 * (i - 1)] + 3, &scan->xyz[3 * other]);
    if (!scan->rings.empty()) std::swap(scan->rings[i - 1], scan->rings[other]);
    if (!scan->phases.empty()) std::swap(scan->phases[i - 1], scan->phases[other]);
  }
}

/// The points of a scan as a driver publishes them. If the scan has lasers and times, each point
/// has both.
struct RawCloud {
  explicit RawCloud(const Scan& scan) {
    const bool has_times = !scan.phases.empty() && !scan.rings.empty();
    layout.fields =
        *PointFields::Parse(has_times ? "x:F32:0,y:F32:4,z:F32:8,timestamp:F32:12,line:U8:16"
                                      : "x:F32:0,y:F32:4,z:F32:8");
    layout.point_step = layout.fields.MinimumStep();
    bytes.resize(scan.xyz.size() / 3 * layout.point_step);
    for (std::size_t i = 0; 3 * i < scan.xyz.size(); ++i) {
      std::uint8_t* point = &bytes[i * layout.point_step];
      std::memcpy(point, &scan.xyz[3 * i], 3 * sizeof(float));
      if (!has_times) continue;
      std::memcpy(point + 12, &scan.phases[i], sizeof(float));
      point[16] = static_cast<std::uint8_t>(scan.rings[i]);
    }
  }
  codec::CloudLayout layout;
  std::vector<std::uint8_t> bytes;
};

/// The encoder and the decoder of a stream.
struct CloudCoders {
  CloudCoders(const codec::CloudLayout& layout, unsigned effort)
      : encoder(*codec::cloud::CloudEncoder::Create(layout)), decoder(UINT32_MAX) {
    encoder.set_effort(effort);
  }
  codec::cloud::CloudEncoder encoder;
  codec::cloud::CloudDecoder decoder;
};

/// Encodes and decodes a scan `repeats` times. Adds the size of the first run, and the shortest
/// times for encoding and for decoding.
void AddCost(const Scan& scan, double error_m, unsigned repeats, CloudCoders* coders,
             CloudCost* cost) {
  const RawCloud raw(scan);
  double encode_s = 0;
  double decode_s = 0;
  for (unsigned i = 0; i < repeats; ++i) {
    const double start = CpuSeconds();
    coders->encoder.Load({raw.bytes.data(), raw.bytes.size()}, false);
    codec::EncodedSlice slice;
    if (coders->encoder.Encode({error_m, 0, 0}, &slice) != codec::SliceResult::kEncoded)
      throw std::runtime_error("the cloud cannot be encoded");
    const double encoded = CpuSeconds();
    if (!coders->decoder.Decode({slice.bytes.data(), slice.bytes.size()}) ||
        coders->decoder.cloud().size() != slice.returns)
      throw std::runtime_error("the slice cannot be decoded");
    const double decoded = CpuSeconds();
    encode_s = i == 0 ? encoded - start : std::min(encode_s, encoded - start);
    decode_s = i == 0 ? decoded - encoded : std::min(decode_s, decoded - encoded);
    if (i > 0) continue;
    cost->points += slice.returns;
    cost->bytes += slice.bytes.size();
    cost->largest_error_m =
        std::max(cost->largest_error_m, LargestGap(scan.xyz, coders->decoder.cloud().xyz));
  }
  cost->encode_s += encode_s;
  cost->decode_s += decode_s;
}

/// Prints the size of the best of Draco's coders.
void PrintDraco(const ScanSet& set, double error_m) {
  double best = 0;
  for (const char* mode : {"xyz-sequential", "xyz-kd0", "xyz-kd6"}) {
    const double step = rate::ErrorBound::Xyz().CoarsestStep(error_m);
    const auto m = Measure(set, ModeNamed(mode), {step, 0, 0, 1});
    if (m && (best <= 0 || m->bits_per_return < best)) best = m->bits_per_return;
  }
  std::printf("  %5.0f mm  Draco     %7.3f\n", 1e3 * error_m, best);
}

void Evaluate(ScanSet set, const CloudsOptions& o) {
  Flatten(&set);
  std::size_t points = 0;
  for (Scan& scan : set.scans) {
    if (o.shuffle) Shuffle(&scan);
    points += scan.xyz.size() / 3;
  }
  std::printf("%s: %zu scans, %zu points%s\n", set.name.c_str(), set.scans.size(), points,
              o.shuffle ? ", shuffled" : "");
  std::printf("  %8s  %-8s  %7s %10s %9s %9s\n", "error", "coder", "bits a", "largest", "encode",
              "decode");
  std::printf("  %8s  %-8s  %7s %10s %9s %9s\n", "", "", "point", "error [mm]", "[ns/pt]",
              "[ns/pt]");
  for (const double error_m : o.errors) {
    PrintDraco(set, error_m);
    for (const unsigned effort : o.efforts) {
      CloudCost cost;
      CloudCoders coders(RawCloud(set.scans.front()).layout, effort);
      for (const Scan& scan : set.scans) AddCost(scan, error_m, o.repeats, &coders, &cost);
      const auto each = 1 / static_cast<double>(cost.points);
      std::printf("  %5.0f mm  effort %u  %7.3f %10.3f %9.0f %9.0f\n", 1e3 * error_m, effort,
                  8 * each * static_cast<double>(cost.bytes), 1e3 * cost.largest_error_m,
                  1e9 * each * cost.encode_s, 1e9 * each * cost.decode_s);
    }
  }
}

}  // namespace

void AddCloudsCommand(CLI::App* app) {
  auto o = std::make_shared<CloudsOptions>();
  CLI::App* command = app->add_subcommand(
      "clouds", "What clouds take without a sensor model, beside Draco; geometry only");
  command->option_defaults()->always_capture_default();
  command->add_option("SOURCE", o->sources, kSourceHelp)->required();
  AddErrorBounds(command, "--errors", &o->errors, "Largest errors [m], comma-separated");
  command->add_option("--efforts", o->efforts, "Efforts of lidarenc, comma-separated")
      ->delimiter(',')
      ->check(CLI::Range(0, 3));
  command->add_flag("--shuffle", o->shuffle, "Put the points into a random order first");
  command->add_option("--repeats", o->repeats, "Runs of each scan; the fastest is timed")
      ->check(CLI::Range(1, 1000));
  command->add_option("--scans", o->source.max_scans, "Scans to read of each source");
  command->callback([o] {
    codec::PrepareMixing();
    for (const std::string& source : o->sources) Evaluate(LoadScans(source, o->source), *o);
  });
}

}  // namespace lidar::tools
