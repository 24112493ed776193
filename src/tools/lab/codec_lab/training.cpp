// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/training.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "src/tools/lab/codec_lab/slice_codec.h"

namespace lidar::tools {
namespace {

using Random = std::mt19937_64;

template <class T>
const T& OneOf(const std::vector<T>& all, Random* random) {
  return all[(*random)() % all.size()];
}

/// Loads random slices until a slice has at least 100 returns. Returns false after 20 slices.
bool LoadRandomSlice(const ScanSet& set, std::uint32_t slices, Random* random, SliceCodec* codec) {
  constexpr int kTries = 20;
  for (int i = 0; i < kTries; ++i) {
    const Scan& scan = OneOf(set.scans, random);
    if (scan.organised() && scan.geometry->model.columns_per_scan % slices != 0) slices = 1;
    codec->Load(scan, {static_cast<std::uint32_t>((*random)() % slices), slices});
    if (codec->returns() >= 100) return true;
  }
  return false;
}

/// Adds a sample of the loaded slice, unless the mode cannot encode the slice.
void AddSample(const CodingMode& mode, const rate::Settings& settings, std::size_t source,
               SliceCodec* codec, std::vector<rate::Sample>* samples) {
  rate::Settings bare = settings;
  bare.intensity_bits = 0;
  const auto geometry = codec->Encode(mode, bare);
  const auto all = settings.intensity_bits > 0 ? codec->Encode(mode, settings) : geometry;
  if (!geometry || !all) return;
  rate::Sample sample;
  sample.source = static_cast<unsigned>(source);
  sample.slice = codec->Features(mode);
  sample.settings = settings;
  sample.settings.step_m = geometry->step_m;
  sample.geometry_bytes = static_cast<double>(geometry->size.bytes());
  sample.intensity_bytes = static_cast<double>((all->size - geometry->size).bytes());
  samples->push_back(sample);
}

bool Suits(const CodingMode& mode, const ScanSet& set) {
  return mode.geometry == Geometry::kXyz || set.organised();
}

rate::Settings PaperSettings(const CodingMode& mode, SliceCodec* codec, Random* random) {
  const rate::ErrorBound bound = codec->Bound(mode);
  const double extent = codec->Features(mode).extent_m;
  const int top = mode.geometry == Geometry::kXyz
                      ? rate::PaperModel::kMaxBits
                      : static_cast<int>(rate::BitsOfStep(extent, bound.FinestStep()));
  std::uniform_int_distribution<int> bits(rate::PaperModel::kMinBits,
                                          std::max(top, rate::PaperModel::kMinBits));
  rate::SettingLimits limits;
  limits.finest_step_m = mode.geometry == Geometry::kXyz ? 1e-9 : bound.FinestStep();
  limits.coarsest_step_m = 1e3;
  limits.step_unit_m = bound.step_unit();
  rate::Settings settings;
  settings.step_m = rate::ClampStep(rate::StepOfBits(extent, bits(*random)), limits);
  return settings;
}

/// Loads random slices into `codec`, and calls take(source) for each of them.
template <class Take>
void ForRandomSlices(const std::vector<ScanSet>& sets, const SamplingOptions& options,
                     const Progress& progress, Random* random, SliceCodec* codec, Take take) {
  const std::size_t all = sets.size() * options.samples;
  for (std::size_t i = 0; i < all; ++i) {
    const std::size_t source = i / options.samples;
    progress(static_cast<double>(i) / static_cast<double>(all));
    if (LoadRandomSlice(sets[source], OneOf(options.slices, random), random, codec)) take(source);
  }
  progress(1);
}

}  // namespace

std::vector<rate::Sample> TakeSamples(const std::vector<ScanSet>& sets,
                                      const SamplingOptions& options, const Progress& progress) {
  Random random(options.seed);
  std::uniform_real_distribution<double> log_step(std::log2(options.min_step_m),
                                                  std::log2(options.max_step_m));
  std::vector<rate::Sample> samples;
  SliceCodec codec;
  ForRandomSlices(sets, options, progress, &random, &codec, [&](std::size_t source) {
    // All modes get the same settings, so the samples of a mode do not depend on the other modes.
    rate::Settings settings;
    settings.step_m = std::exp2(log_step(random));
    settings.intensity_bits = static_cast<unsigned>(random() % (options.intensity_bits + 1));
    for (const std::string& name : options.modes) {
      const CodingMode& mode = ModeNamed(name);
      if (!Suits(mode, sets[source])) continue;
      settings.level = mode.level;
      AddSample(mode, settings, source, &codec, &samples);
    }
  });
  return samples;
}

std::vector<rate::Sample> TakePaperSamples(const std::vector<ScanSet>& sets,
                                           const SamplingOptions& options,
                                           const Progress& progress) {
  Random random(options.seed);
  const CodingMode* range = nullptr;
  for (const std::string& name : options.modes)
    if (ModeNamed(name).geometry == Geometry::kRange && range == nullptr) range = &ModeNamed(name);
  std::vector<rate::Sample> samples;
  SliceCodec codec;
  ForRandomSlices(sets, options, progress, &random, &codec, [&](std::size_t source) {
    const auto level = static_cast<unsigned>(random() % (rate::PaperModel::kMaxLevel + 1));
    for (const CodingMode* mode : {&XyzModeOfLevel(level), range}) {
      if (mode == nullptr || !Suits(*mode, sets[source])) continue;
      rate::Settings settings = PaperSettings(*mode, &codec, &random);
      settings.intensity_bits = options.intensity_bits;
      settings.level = level;
      AddSample(*mode, settings, source, &codec, &samples);
    }
  });
  return samples;
}

FitReport Report(
    const std::string& name, const std::vector<rate::Sample>& samples,
    const std::function<std::unique_ptr<rate::SizeModel>(const std::vector<rate::Sample>&)>& fit) {
  FitReport report;
  report.name = name;
  report.samples = samples.size();
  const auto whole = fit(samples);
  if (!whole) return report;
  report.fit = rate::ErrorOf(*whole, samples);
  const bool one_source = std::all_of(samples.begin(), samples.end(), [&](const auto& s) {
    return s.source == samples.front().source;
  });
  const unsigned folds =
      one_source ? 5 : 1 + std::max_element(samples.begin(), samples.end(), [](auto& a, auto& b) {
                             return a.source < b.source;
                           })->source;
  unsigned done = 0;
  for (unsigned fold = 0; fold < folds; ++fold) {
    std::vector<rate::Sample> rest;
    std::vector<rate::Sample> left_out;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const bool out = (one_source ? i % folds : samples[i].source) == fold;
      (out ? left_out : rest).push_back(samples[i]);
    }
    const auto model = left_out.empty() ? nullptr : fit(rest);
    if (!model) continue;
    const rate::FitError error = rate::ErrorOf(*model, left_out);
    report.cross_validation.mean += error.mean;
    report.cross_validation.percentile_95 =
        std::max(report.cross_validation.percentile_95, error.percentile_95);
    ++done;
  }
  if (done > 0) report.cross_validation.mean /= done;
  return report;
}

}  // namespace lidar::tools
