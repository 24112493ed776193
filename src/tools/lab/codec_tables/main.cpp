// SPDX-License-Identifier: LGPL-2.1-or-later
// codec-tables: counts symbols in captures, and prints the tables from which the coder's models
// start.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <numeric>
#include <string>

#include "src/codec/intensity_scale.h"
#include "src/codec/rans/adaptive_coder.h"
#include "src/tools/common/output_file.h"
#include "src/tools/lab/codec_lab/scan_source.h"

namespace lidar::tools {
namespace {

using codec::SymbolCounts;

// All captures in tests/data/ouster that contain a whole turn. Synthetic worlds are not used. They
// would need floating point, and so might give different tables on another machine.
constexpr const char* kCaptures[] = {
    "OS-0-32-U1_v2.2.0_1024x10.pcap", "OS-1-32-G_v2.1.1_1024x10.pcap",
    "OS-0-128-U1_v2.3.0_1024x10.pcap",
    "OS-1-128_v2.3.0_1024x10_lb_n3.pcap,OS-1-128_v2.3.0_1024x10.json"};
constexpr std::uint32_t kSlices = 8;
constexpr double kErrors[] = {0.002, 0.005, 0.01, 0.02, 0.05, 0.1};
constexpr unsigned kIntensityBits[] = {5, 8};
constexpr std::uint64_t kFewestSymbols = 100;  // a context with fewer symbols is left out

struct Counts {
  SymbolCounts values;
  SymbolCounts levels;
};

/// Counts the symbols of the bins and of the levels in a slice.
void CountSlice(const Scan& scan, SliceOf slice, const RangeGrid& grid, unsigned bits,
                Counts* counts) {
  const ColumnWindow window = WindowOf(scan, slice);
  const SensorModel& model = scan.geometry->model;
  const codec::AzimuthAlignment alignment(model);
  const codec::IntensityScale fine(codec::FullScale::kByte, codec::IntensityScale::kMaxBits);
  const codec::IntensityScale coarse(codec::FullScale::kByte, bits);
  codec::Mask mask;
  codec::IntegerLists lists;
  for (std::size_t beam = 0; beam < model.beams.size(); ++beam) {
    for (std::uint32_t i = 0; i < window.count; ++i) {
      const std::size_t at = beam * model.columns_per_scan + window.first + i;
      mask.push_back(scan.ranges[at] != 0 ? 1 : 0);
      if (scan.ranges[at] == 0) continue;
      lists.values.push_back(static_cast<std::int32_t>(grid.BinOf(scan.ranges[at])));
      lists.levels.push_back(coarse.Coarsen(fine.LevelOf(scan.intensity[at])));
    }
  }
  codec::AdaptiveCoder().Count({alignment, mask, window.count}, lists, &counts->values,
                               &counts->levels);
}

/// Adds `counts` to `sum`. Every context has the same weight, however often it occurred.
void AddEvenly(const SymbolCounts& counts, SymbolCounts* sum) {
  const auto add = [](const auto& from, auto* to) {
    constexpr std::uint64_t kShare = 1'000'000'000;
    const auto all = std::accumulate(from.begin(), from.end(), std::uint64_t{0});
    if (all < kFewestSymbols) return;
    for (std::size_t i = 0; i < from.size(); ++i) (*to)[i] += from[i] * kShare / all;
  };
  for (std::size_t i = 0; i < counts.residuals.size(); ++i)
    add(counts.residuals[i], &sum->residuals[i]);
  add(counts.longs, &sum->longs);
}

void CountCapture(const ScanSet& set, Counts* sum) {
  for (const double error : kErrors) {
    Counts counts;
    for (const Scan& scan : set.scans) {
      const auto grid = RangeGrid::ForError(error, scan.geometry->model.range_unit_mm);
      for (std::uint32_t i = 0; i < kSlices; ++i)
        for (const unsigned bits : kIntensityBits)
          CountSlice(scan, {i, kSlices}, grid, bits, &counts);
    }
    AddEvenly(counts.values, &sum->values);
    AddEvenly(counts.levels, &sum->levels);
  }
}

/// Returns the frequencies in a thousand. A frequency is never 0.
std::string Frequencies(const std::array<std::uint64_t, codec::kNibbles>& counts) {
  const auto all = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  std::string text;
  for (const std::uint64_t n : counts) {
    const std::uint64_t share =
        all == 0 ? 1 : std::max<std::uint64_t>(1, (1000 * n + all / 2) / all);
    text += (text.empty() ? "" : ", ") + std::to_string(share);
  }
  return text;
}

void Print(const char* name, const SymbolCounts& counts) {
  std::printf("constexpr std::array<Counts, kContexts> k%s = {{\n", name);
  for (const auto& context : counts.residuals)
    std::printf("    {{%s}},\n", Frequencies(context).c_str());
  std::printf("}};\nconstexpr Counts kLong%s = {{%s}};\n", name, Frequencies(counts.longs).c_str());
}

void Run(const std::string& folder) {
  Counts sum;
  for (const std::string capture : kCaptures) {
    const std::size_t comma = capture.find(',');
    std::string source = folder + "/" + capture.substr(0, comma);
    if (comma != std::string::npos) source += "," + folder + "/" + capture.substr(comma + 1);
    CountCapture(LoadScans(source, {}), &sum);
  }
  std::puts("// SPDX-License-Identifier: LGPL-2.1-or-later");
  std::puts("// Made by codec-tables; part of the format. Frequencies of symbols in a thousand.");
  Print("Values", sum.values);
  Print("Levels", sum.levels);
  FinishStandardOutput();
}

}  // namespace
}  // namespace lidar::tools

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: codec-tables tests/data/ouster >src/codec/rans/initial_counts.inc\n",
               stderr);
    return 2;
  }
  try {
    lidar::tools::Run(argv[1]);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "codec-tables: %s\n", e.what());
    return 1;
  }
}
