// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-eval predict: measures the errors of predicted sizes, before and after an encoded slice has
// corrected the model.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

#include "src/tools/lab/codec_lab/measure.h"
#include "src/tools/lab/codec_lab/model_option.h"
#include "src/tools/lab/codec_lab/plot.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "src/tools/lab/codec_lab/tracking.h"
#include "src/tools/lab/codec_lab/training.h"
#include "src/tools/lab/lidar_eval/commands.h"

namespace lidar::tools {
namespace {

struct PredictOptions {
  std::vector<std::string> sources;
  SourceOptions source;
  SamplingOptions sampling;
  std::string model;
  double min_step_m = 0.002;
  double max_step_m = 0.2;
};

std::string Cell(const rate::FitError& e) {
  return e.mean > 0 ? Format("%7.1f %% %7.1f %%", 100 * e.mean, 100 * e.percentile_95)
                    : Format("%19s", "-");
}

/// Predicts the size of each scan at a random step. The scan before it has corrected the model.
rate::FitError Corrected(const ScanSet& set, const CodingMode& mode, const PredictOptions& o,
                         rate::SizeModel* model) {
  std::mt19937_64 random(o.sampling.seed);
  std::uniform_real_distribution<double> log_step(std::log2(o.min_step_m), std::log2(o.max_step_m));
  SliceCodec codec;
  std::vector<double> errors;
  for (std::size_t i = 0; i < o.sampling.samples; ++i) {
    codec.Load(set.scans[ThereAndBack(i, set.scans.size())], {});
    rate::SliceFeatures features = codec.Features(mode);
    features.scan_id = static_cast<std::uint32_t>(i);
    const rate::Settings settings{std::exp2(log_step(random)), 0, mode.level};
    const auto encoded = codec.Encode(mode, settings);
    if (!encoded) continue;
    const double predicted = model->Predict(features, {encoded->step_m, 0, settings.level}).total();
    if (i > 0)
      errors.push_back(std::abs(predicted / static_cast<double>(encoded->size.bytes()) - 1));
    model->OnEncoded(features, settings, *encoded);
  }
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  double sum = 0;
  for (const double e : errors) sum += e;
  return {sum / static_cast<double>(errors.size()), errors[(errors.size() - 1) * 95 / 100]};
}

void Evaluate(const ScanSet& set, const rate::ModelFile& file, const PredictOptions& o) {
  SamplingOptions sampling = o.sampling;
  sampling.min_step_m = o.min_step_m;
  sampling.max_step_m = o.max_step_m;
  sampling.slices = {1};
  const std::vector<ScanSet> one = {set};
  std::printf("%s: %zu scans\n", set.name.c_str(), set.scans.size());
  std::printf("  %-16s %8s %21s %21s %21s\n", "", "samples", "paper: mean     p95",
              "ours: mean     p95", "corrected: mean p95");
  for (const std::string& name : o.sampling.modes) {
    const CodingMode& mode = ModeNamed(name);
    if (mode.geometry == Geometry::kRange && !set.organised()) continue;
    sampling.modes = {name};
    const auto samples = TakeSamples(one, sampling, [](double) {});
    std::string no_paper;
    const auto paper = rate::MakeModel(file, rate::RateModel::kPaper, &no_paper);
    const auto ours = MakeModelOrThrow(file, rate::RateModel::kAdaptive);
    const rate::FitError fresh = rate::ErrorOf(*ours, samples);
    const rate::FitError corrected = Corrected(set, mode, o, ours.get());
    std::printf("  %-16s %8zu %21s %21s %21s\n", name.c_str(), samples.size(),
                paper ? Cell(rate::ErrorOf(*paper, samples)).c_str() : "-", Cell(fresh).c_str(),
                Cell(corrected).c_str());
  }
}

void RunPredict(const PredictOptions& o) {
  const rate::ModelFile file = LoadModelFile(o.model);
  std::printf("model trained on: %s\nsteps %g to %g m, whole scans, geometry only\n",
              file.trained_on.c_str(), o.min_step_m, o.max_step_m);
  for (const std::string& source : o.sources) Evaluate(LoadScans(source, o.source), file, o);
}

}  // namespace

void AddPredictCommand(CLI::App* app) {
  auto o = std::make_shared<PredictOptions>();
  o->sampling.modes = {DefaultRangeMode().name, "xyz-sequential", "xyz-kd0", "xyz-kd6"};
  o->sampling.intensity_bits = 0;
  o->sampling.seed = 2;
  CLI::App* command = app->add_subcommand(
      "predict", "Errors of a model file's predictions, for slices that it was not trained on");
  command->option_defaults()->always_capture_default();
  command->add_option("SOURCE", o->sources, kSourceHelp)->required();
  command->add_option("--model", o->model, "Model file of lidar-train; empty: the built-in one");
  command->add_option("--modes", o->sampling.modes, "Coding modes, comma-separated")
      ->delimiter(',');
  command->add_option("--samples", o->sampling.samples, "Slices of each source and mode")
      ->check(CLI::Range(2, 100000));
  command->add_option("--min-step", o->min_step_m, "Finest step [m]")
      ->check(CLI::Range(1e-4, 10.0));
  command->add_option("--max-step", o->max_step_m, "Coarsest step [m]")
      ->check(CLI::Range(1e-4, 10.0));
  command->add_option("--scans", o->source.max_scans, "Scans to read of each source");
  command->add_option("--speed", o->source.speed_mps, "Speed of synthetic drives [m/s]");
  command->add_option("--seed", o->sampling.seed, "Seed of the random settings");
  command->callback([o] {
    if (o->min_step_m >= o->max_step_m)
      throw CLI::ValidationError("--min-step", "must be below --max-step");
    RunPredict(*o);
  });
}

}  // namespace lidar::tools
