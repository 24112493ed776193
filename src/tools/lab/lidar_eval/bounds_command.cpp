// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-eval bounds: measures the bitrates that error bounds need.
#include <cmath>
#include <cstdio>
#include <memory>

#include "src/rate/paper_model.h"
#include "src/tools/lab/codec_lab/measure.h"
#include "src/tools/lab/codec_lab/plot.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "src/tools/lab/lidar_eval/commands.h"

namespace lidar::tools {
namespace {

struct BoundsOptions {
  std::vector<std::string> sources;
  SourceOptions source;
  std::vector<double> errors = {0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2};
  std::vector<double> max_errors = {0.02, 0.05};
  std::string range_mode;  // empty: the default
  std::string xyz_mode = "xyz-kd6";
  std::uint32_t slices = 1;
  unsigned intensity_bits = 0;
  std::string csv;
};

std::string Cells(const std::optional<Measurement>& m) {
  if (!m) return Format("%53s", "-");
  return Format("%8.1f %5.1f %7.2f %7.2f %9.2f %9.3f", 1e3 * m->step_m, m->quantization_bits,
                1e3 * m->errors.mean_m, 1e3 * m->errors.max_m, m->bits_per_return,
                1e-6 * m->bitrate);
}

void WriteRow(const ScanSet& set, const CodingMode& mode, double error,
              const std::optional<Measurement>& m, CsvFile* csv) {
  if (!m) return;
  csv->Row(Format("%s,%s,%g,%g,%.3f,%g,%g,%.4f,%.0f", set.name.c_str(), mode.name.c_str(), error,
                  m->step_m, m->quantization_bits, m->errors.mean_m, m->errors.max_m,
                  m->bits_per_return, m->bitrate));
}

std::optional<Measurement> AtError(const ScanSet& set, const CodingMode& mode, double error,
                                   const BoundsOptions& o) {
  if (mode.geometry == Geometry::kRange && !set.organised()) return std::nullopt;
  SliceCodec codec;
  codec.Load(set.scans.front(), {});
  return Measure(set, mode, {codec.Bound(mode).CoarsestStep(error), 0, o.intensity_bits, o.slices});
}

/// Prints the number of bits and the bitrate that the paper needs for an error bound. The bits are
/// the fewest bits of a coordinate in the bounding cube with which every scan keeps the bound. The
/// bitrate is that of the level that needs the fewest bytes.
void PrintPaperMinimum(const ScanSet& set, double error, const BoundsOptions& o) {
  double extent = 0;
  SliceCodec codec;
  for (const Scan& scan : set.scans) {
    codec.Load(scan, {});
    extent = std::max(extent, codec.Features(ModeNamed("xyz-kd6")).extent_m);
  }
  const double bits =
      std::ceil(rate::BitsOfStep(extent, rate::ErrorBound::Xyz().CoarsestStep(error)));
  double least = 0;
  const char* of = "";
  for (const char* name : {"xyz-sequential", "xyz-kd0", "xyz-kd2", "xyz-kd4", "xyz-kd6"}) {
    const auto m =
        Measure(set, ModeNamed(name), {0, static_cast<unsigned>(bits), o.intensity_bits, 1});
    if (m && (least <= 0 || m->bitrate < least)) {
      least = m->bitrate;
      of = name;
    }
  }
  std::printf("  %4.0f mm   automatic bits of the cube: q = %2.0f, %-14s %8.3f Mbit/s", 1e3 * error,
              bits, of, 1e-6 * least);
}

void Evaluate(const ScanSet& set, const BoundsOptions& o, CsvFile* csv) {
  const CodingMode& range = o.range_mode.empty() ? DefaultRangeMode() : ModeNamed(o.range_mode);
  const CodingMode& xyz = ModeNamed(o.xyz_mode);
  std::printf("%s: %zu scans at %g Hz, %u slice(s) a scan, %u intensity bits\n", set.name.c_str(),
              set.scans.size(), set.scans_per_second, o.slices, o.intensity_bits);
  std::printf("%8s | %-53s | %-53s\n", "", xyz.name.c_str(), range.name.c_str());
  const char* columns = "    step     q    mean     max bits/ret.    Mbit/s";
  std::printf("%8s | %-53s | %-53s\n", "error", columns, columns);
  std::printf("%8s | %-53s | %-53s\n", "[mm]", "    [mm]          [mm]    [mm]",
              "    [mm]          [mm]    [mm]");
  for (const double error : o.errors) {
    const auto of_xyz = AtError(set, xyz, error, o);
    const auto of_range = AtError(set, range, error, o);
    std::printf("%8.1f | %-53s | %-53s\n", 1e3 * error, Cells(of_xyz).c_str(),
                Cells(of_range).c_str());
    WriteRow(set, xyz, error, of_xyz, csv);
    WriteRow(set, range, error, of_range, csv);
  }
  std::printf("r_min, the bitrate that an error bound needs:\n");
  for (const double error : o.max_errors) {
    PrintPaperMinimum(set, error, o);
    for (const CodingMode* mode : {&xyz, &range})
      if (const auto m = AtError(set, *mode, error, o))
        std::printf(" | %s %8.3f Mbit/s", mode->name.c_str(), 1e-6 * m->bitrate);
    std::printf("\n");
  }
  std::printf("\n");
}

void RunBounds(const BoundsOptions& o) {
  CsvFile csv(o.csv,
              "source,mode,error_bound_m,step_m,quantization_bits,mean_error_m,max_error_m,"
              "bits_per_return,bitrate_bps");
  for (const std::string& source : o.sources) Evaluate(LoadScans(source, o.source), o, &csv);
  csv.Close();
}

}  // namespace

void AddBoundsCommand(CLI::App* app) {
  auto o = std::make_shared<BoundsOptions>();
  CLI::App* command = app->add_subcommand(
      "bounds", "Step, real error, size and bitrate for a list of error bounds");
  command->option_defaults()->always_capture_default();
  command->add_option("SOURCE", o->sources, kSourceHelp)->required();
  AddErrorBounds(command, "--errors", &o->errors, "Error bounds [m], comma-separated");
  AddErrorBounds(command, "--max-error", &o->max_errors, "Bounds whose r_min is wanted [m]");
  command->add_option("--range-mode", o->range_mode,
                      "Coding mode of range geometry; empty: dracoenc's default");
  command->add_option("--xyz-mode", o->xyz_mode, "Coding mode of xyz geometry");
  command->add_option("--slices", o->slices, "Slices per scan")->check(CLI::Range(1U, 64U));
  command->add_option("--intensity-bits", o->intensity_bits, "0: geometry only")
      ->check(CLI::Range(0U, codec::IntensityScale::kMaxBits));
  command->add_option("--scans", o->source.max_scans, "Scans to read of each source");
  command->add_option("--speed", o->source.speed_mps, "Speed of synthetic drives [m/s]");
  command->add_option("--csv", o->csv, "Write the table to this file as well");
  command->callback([o] { RunBounds(*o); });
}

}  // namespace lidar::tools
