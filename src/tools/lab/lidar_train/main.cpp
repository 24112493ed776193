// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-train: fits the rate models to captures, clouds and synthetic drives.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <map>

#include "src/rate/model_file.h"
#include "src/tools/common/output_file.h"
#include "src/tools/common/program.h"
#include "src/tools/lab/codec_lab/progress.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "src/tools/lab/codec_lab/slice_codec.h"
#include "src/tools/lab/codec_lab/training.h"

namespace lidar::tools {
namespace {

struct Options {
  std::vector<std::string> sources;
  SourceOptions source;
  SamplingOptions sampling;
  std::string model = "both";
  std::string output;
  std::string description;
};

Options ParseOptions(int argc, char** argv) {
  Options o;
  for (const CodingMode& mode : AllModes()) o.sampling.modes.push_back(mode.name);
  CLI::App app(
      "Fits the models that predict the size of an encoded slice: encodes slices at random\n"
      "settings, prints how well the fits predict them and slices they were not fitted to\n"
      "(each source left out in turn), and writes the file for dracoenc model-location=.");
  AddVersionFlag(&app, "lidar-train");
  app.option_defaults()->always_capture_default();
  app.add_option("SOURCE", o.sources, kSourceHelp)->required();
  app.add_option("-o,--output", o.output, "Model file to write (JSON)");
  app.add_option("--model", o.model, "Models to fit: adaptive, paper or both")
      ->check(CLI::IsMember({"adaptive", "paper", "both"}));
  app.add_option("--samples", o.sampling.samples, "Slices of each source")
      ->check(CLI::Range(rate::kMinSamples, std::size_t{100000}));
  app.add_option("--modes", o.sampling.modes, "Coding modes, comma-separated")->delimiter(',');
  app.add_option("--min-step", o.sampling.min_step_m, "Finest step [m]")
      ->check(CLI::Range(1e-4, 10.0));
  app.add_option("--max-step", o.sampling.max_step_m, "Coarsest step [m]")
      ->check(CLI::Range(1e-4, 10.0));
  app.add_option("--slices", o.sampling.slices, "Slices per scan to draw from, comma-separated")
      ->delimiter(',')
      ->check(CLI::Range(1U, 64U));
  app.add_option("--intensity-bits", o.sampling.intensity_bits,
                 "Adaptive: drawn from 0 to this; paper: always this")
      ->check(CLI::Range(0U, codec::IntensityScale::kMaxBits));
  app.add_option("--scans", o.source.max_scans, "Scans to read of each source")
      ->check(CLI::Range(1, 100000));
  app.add_option("--speed", o.source.speed_mps, "Speed of synthetic drives [m/s]");
  app.add_option("--world-seed", o.source.seed, "Seed of synthetic worlds");
  app.add_option("--seed", o.sampling.seed, "Seed of the random settings");
  app.add_option("--description", o.description, "Text for the file's \"trained-on\"");
  Parse(&app, argc, argv, [&] {
    for (const std::string& name : o.sampling.modes) ModeNamed(name);
    if (o.sampling.min_step_m >= o.sampling.max_step_m)
      throw CLI::ValidationError("--min-step", "must be below --max-step");
  });
  return o;
}

std::string Describe(const Options& options) {
  if (!options.description.empty()) return options.description;
  std::string text;
  for (const std::string& source : options.sources) text += (text.empty() ? "" : ", ") + source;
  return text;
}

void Print(const FitReport& r) {
  if (r.fit.mean <= 0) {
    std::printf("%-16s %8zu   too few samples, or sizes that do not fall with the step\n",
                r.name.c_str(), r.samples);
    return;
  }
  std::printf("%-16s %8zu %8.1f %% %8.1f %% %12.1f %% %8.1f %%\n", r.name.c_str(), r.samples,
              100 * r.fit.mean, 100 * r.fit.percentile_95, 100 * r.cross_validation.mean,
              100 * r.cross_validation.percentile_95);
}

void FitAndPrintAdaptive(const std::vector<rate::Sample>& samples, rate::ModelFile* file) {
  file->adaptive = rate::FitAdaptive(samples);
  std::map<std::string, std::vector<rate::Sample>> by_mode;
  for (const rate::Sample& s : samples) by_mode[s.slice.mode].push_back(s);
  for (const auto& [name, of_mode] : by_mode)
    Print(Report(name, of_mode, [](const auto& some) -> std::unique_ptr<rate::SizeModel> {
      const auto fit = rate::FitAdaptive(some);
      return fit ? std::make_unique<rate::AdaptiveModel>(*fit) : nullptr;
    }));
}

void FitAndPrintPaper(const std::vector<rate::Sample>& samples, rate::ModelFile* file) {
  file->paper = rate::FitPaper(samples);
  std::map<std::string, std::vector<rate::Sample>> by_geometry;
  for (const rate::Sample& s : samples) by_geometry[rate::GeometryOf(s.slice.mode)].push_back(s);
  for (const auto& [name, of_geometry] : by_geometry)
    Print(Report("paper, " + name, of_geometry,
                 [](const auto& some) -> std::unique_ptr<rate::SizeModel> {
                   const auto fit = rate::FitPaper(some);
                   return fit ? std::make_unique<rate::PaperModel>(*fit) : nullptr;
                 }));
}

int Run(const Options& options) {
  const std::vector<ScanSet> sets = LoadAllScans(options.sources, options.source);
  rate::ModelFile file;
  file.trained_on = Describe(options);
  std::vector<rate::Sample> adaptive;
  std::vector<rate::Sample> paper;
  if (options.model != "paper") {
    adaptive = TakeSamples(sets, options.sampling, ProgressBar("adaptive"));
  }
  if (options.model != "adaptive") {
    paper = TakePaperSamples(sets, options.sampling, ProgressBar("paper"));
  }
  std::printf("%-16s %8s %21s %24s\n", "", "samples", "fit: mean     p95",
              "left out: mean     p95");
  if (options.model != "paper") FitAndPrintAdaptive(adaptive, &file);
  if (options.model != "adaptive") FitAndPrintPaper(paper, &file);
  const bool complete =
      (options.model == "paper" || file.adaptive) && (options.model == "adaptive" || file.paper);
  if (!complete) {
    std::cerr << "lidar-train: no model could be fitted; use more --samples, or other --modes or "
                 "sources\n";
    return 1;
  }
  if (options.output.empty()) return 0;
  WriteFile(options.output, rate::WriteModelFile(file));
  return 0;
}

}  // namespace
}  // namespace lidar::tools

int main(int argc, char** argv) {
  using namespace lidar::tools;
  return Guard("lidar-train", [&] { return Run(ParseOptions(argc, argv)); });
}
