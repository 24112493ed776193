// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-eval rd: measures rate and distortion of our coder, and of the paper's setting.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "src/codec/effort_control.h"
#include "src/tools/lab/codec_lab/measure.h"
#include "src/tools/lab/codec_lab/plot.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "src/tools/lab/lidar_eval/commands.h"

namespace lidar::tools {
namespace {

struct RdOptions {
  std::vector<std::string> sources;
  SourceOptions source;
  std::vector<std::string> modes = {DefaultRangeMode().name};
  std::vector<unsigned> efforts;  // if not empty, replaces `modes`
  std::vector<std::uint32_t> slices = {1, 8};
  unsigned intensity_bits = 0;
  std::vector<double> errors = {0.002, 0.003, 0.005, 0.007, 0.01, 0.015,
                                0.02,  0.03,  0.05,  0.07,  0.1,  0.2};
  std::string csv;
  std::string plot;
};

struct Curve {
  std::string name;
  std::vector<Measurement> points;
};

/// Measures the paper's setting, in which Draco quantises the bounding cube.
Curve PaperCurve(const ScanSet& set, const std::string& mode, const char* name) {
  constexpr unsigned kFewestBits = 8;
  constexpr unsigned kMostBits = 17;  // with more bits, Draco codes the sensor's noise
  Curve curve{name, {}};
  for (unsigned q = kFewestBits; q <= kMostBits; ++q)
    if (const auto m = Measure(set, ModeNamed(mode), {0, q, 0, 1})) curve.points.push_back(*m);
  return curve;
}

Curve OurCurve(const ScanSet& set, const std::string& name, std::uint32_t slices,
               const RdOptions& o) {
  const CodingMode& mode = ModeNamed(name);
  Curve curve{name + (slices == 1 ? ", whole scans" : Format(", %u slices", slices)), {}};
  SliceCodec codec;
  codec.Load(set.scans.front(), {});
  for (const double error : o.errors) {
    const double step = codec.Bound(mode).CoarsestStep(error);
    if (!curve.points.empty() && curve.points.back().step_m >= step) continue;
    if (const auto m = Measure(set, mode, {step, 0, o.intensity_bits, slices}))
      curve.points.push_back(*m);
  }
  return curve;
}

std::vector<Curve> Evaluate(const ScanSet& set, const RdOptions& o, CsvFile* csv) {
  std::vector<Curve> curves = {PaperCurve(set, "xyz-sequential", "paper: automatic bits, level 0"),
                               PaperCurve(set, "xyz-kd6", "paper: automatic bits, level 7")};
  std::vector<std::string> modes = o.efforts.empty() ? o.modes : std::vector<std::string>{};
  for (const unsigned effort : o.efforts) modes.push_back(ModeOfEffort(effort).name);
  for (const std::string& mode : modes) {
    if (ModeNamed(mode).geometry == Geometry::kRange && !set.organised()) continue;
    for (const std::uint32_t slices : o.slices) curves.push_back(OurCurve(set, mode, slices, o));
  }
  std::printf("%s: %zu scans, intensity of %u bits beside ranges\n", set.name.c_str(),
              set.scans.size(), o.intensity_bits);
  std::printf("  %-32s %9s %9s %9s %9s %9s %9s\n", "", "step", "q", "mean", "max", "bits per",
              "Mbit/s");
  std::printf("  %-32s %9s %9s %9s %9s %9s\n", "", "[mm]", "", "[mm]", "[mm]", "return");
  for (const Curve& curve : curves) {
    for (const Measurement& m : curve.points) {
      std::printf("  %-32s %9.2f %9.2f %9.2f %9.2f %9.3f %9.3f\n", curve.name.c_str(),
                  1e3 * m.step_m, m.quantization_bits, 1e3 * m.errors.mean_m, 1e3 * m.errors.max_m,
                  m.bits_per_return, 1e-6 * m.bitrate);
      csv->Row(Format("%s,\"%s\",%g,%.3f,%g,%g,%.4f,%.0f", set.name.c_str(), curve.name.c_str(),
                      m.step_m, m.quantization_bits, m.errors.mean_m, m.errors.max_m,
                      m.bits_per_return, m.bitrate));
    }
  }
  return curves;
}

/// Returns gnuplot commands that draw the curves of one source.
std::string Draw(const std::string& title, const std::vector<Curve>& curves) {
  std::string data;
  std::string lines;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    data += Format("$c%zu << EOD\n", i);
    for (const Measurement& m : curves[i].points)
      data += Format("%g,%g\n", 1e3 * m.errors.max_m, m.bits_per_return);
    data += "EOD\n";
    lines += Format("%s$c%zu using 1:2 with linespoints pt 7 ps 0.6 lw 2 title '%s'",
                    i == 0 ? "plot " : ", ", i, curves[i].name.c_str());
  }
  return data + "set title '" + title + "' noenhanced\n" + lines + "\n";
}

void RunRd(const RdOptions& o) {
  CsvFile csv(o.csv,
              "source,coding,step_m,quantization_bits,mean_error_m,max_error_m,bits_per_return,"
              "bitrate_bps");
  std::string plots;
  for (const std::string& source : o.sources) {
    const ScanSet set = LoadScans(source, o.source);
    plots += Draw(set.name, Evaluate(set, o, &csv));
  }
  csv.Close();
  if (o.plot.empty()) return;
  const std::size_t columns = std::min<std::size_t>(o.sources.size(), 2);
  const std::size_t rows = (o.sources.size() + columns - 1) / columns;
  Plot(o.plot, Format("set terminal png size %zu,%zu font ',11'\nset output '%s'\n", 900 * columns,
                      500 * rows, o.plot.c_str()) +
                   Format("set multiplot layout %zu,%zu\n", rows, columns) +
                   "set logscale x\nset xrange [1:300]\nset yrange [0:30]\n"
                   "set xlabel 'largest point error [mm]'\nset ylabel 'bits per return'\n" +
                   plots + "unset multiplot\n");
}

}  // namespace

void AddRateDistortionCommand(CLI::App* app) {
  auto o = std::make_shared<RdOptions>();
  CLI::App* command = app->add_subcommand(
      "rd", "Rate against distortion: our coding modes, and Draco set up as in the paper");
  command->option_defaults()->always_capture_default();
  command->add_option("SOURCE", o->sources, kSourceHelp)->required();
  command->add_option("--modes", o->modes, "Coding modes, comma-separated")->delimiter(',');
  command->add_option("--effort", o->efforts, "Efforts of our coder, in place of modes")
      ->delimiter(',')
      ->check(CLI::Range(0U, codec::EffortControl::kHighest));
  command->add_option("--intensity-bits", o->intensity_bits, "0: geometry only")
      ->check(CLI::Range(0U, codec::IntensityScale::kMaxBits));
  command->add_option("--slices", o->slices, "Slices per scan, comma-separated")
      ->delimiter(',')
      ->check(CLI::Range(1U, 64U));
  AddErrorBounds(command, "--errors", &o->errors, "Error bounds [m], comma-separated");
  command->add_option("--scans", o->source.max_scans, "Scans to read of each source");
  command->add_option("--speed", o->source.speed_mps, "Speed of synthetic drives [m/s]");
  command->add_option("--csv", o->csv, "Write the table to this file as well");
  command->add_option("--plot", o->plot, "Draw all sources into this PNG");
  command->callback([o] { RunRd(*o); });
}

}  // namespace lidar::tools
