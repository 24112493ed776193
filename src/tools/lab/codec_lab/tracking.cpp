// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/tracking.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>

namespace lidar::tools {
namespace {

rate::ControllerParameters Parameters(const TrackOptions& o, SliceCodec* codec) {
  const rate::ErrorBound bound = codec->Bound(*o.mode);
  rate::ControllerParameters parameters;
  parameters.limits.finest_step_m = bound.FinestStep();
  parameters.limits.coarsest_step_m = bound.CoarsestStep(o.max_error_m);
  parameters.limits.step_unit_m = bound.step_unit();
  parameters.limits.intensity_bits = o.intensity_bits;
  parameters.limits.level = o.mode->level;
  parameters.degradation = o.degradation;
  parameters.closed_loop = !o.open_loop;
  return parameters;
}

struct Player {
  const ScanSet& set;
  const TrackOptions& options;
  rate::RateController& controller;
  SliceCodec codec;

  void Slice(std::uint32_t scan_id, std::uint32_t index, TrackedScan* tracked) {
    rate::SliceFeatures features = codec.Features(*options.mode);
    features.scan_id = scan_id;
    features.slice_index = index;
    features.slice_count = options.slices;
    features.scans_per_second = set.scans_per_second;
    const rate::Decision decision = controller.NextSlice(features);
    tracked->skipped = decision.skip;
    tracked->keep_fraction = decision.keep_fraction;
    tracked->intensity_bits = decision.settings.intensity_bits;
    if (decision.skip || codec.returns() == 0) return;
    rate::Settings settings = decision.settings;
    auto encoded = Encode(settings, decision.keep_fraction);
    if (const auto again = controller.OnEncoded(encoded)) {
      settings = *again;
      encoded = Encode(settings, decision.keep_fraction);
      controller.OnEncoded(encoded);
      ++tracked->reencoded;
    }
    tracked->sent_bps += encoded.size.bits() * set.scans_per_second;
    tracked->coarsest_step_m = std::max(tracked->coarsest_step_m, encoded.step_m);
    tracked->largest_bound_m =
        std::max(tracked->largest_bound_m, codec.Bound(*options.mode).MaxError(encoded.step_m));
  }

  rate::EncodedSize Encode(const rate::Settings& settings, double keep) {
    // The paper's model chooses Draco's level. The level decides which of Draco's coders is used.
    const CodingMode& mode =
        options.mode->geometry == Geometry::kXyz ? XyzModeOfLevel(settings.level) : *options.mode;
    const auto encoded = codec.Encode(mode, settings, keep);
    if (!encoded) throw std::runtime_error("the codec refused a slice");
    return *encoded;
  }
};

}  // namespace

std::size_t ThereAndBack(std::size_t i, std::size_t count) {
  if (count < 2) return 0;
  const std::size_t at = i % (2 * count - 2);
  return at < count ? at : 2 * count - 2 - at;
}

std::vector<double> MakeTargets(TargetProfile profile, std::size_t scans, const ProfileOptions& o) {
  constexpr double kWalk = 0.08;
  constexpr std::size_t kJumpEvery = 10;
  std::mt19937_64 random(o.seed);
  std::normal_distribution<double> step(0, kWalk);
  std::uniform_real_distribution<double> anywhere(std::log(o.min_bps), std::log(o.max_bps));
  std::vector<double> targets(scans, o.steady_bps);
  double target = std::sqrt(o.min_bps * o.max_bps);
  for (std::size_t i = 0; profile != TargetProfile::kSteady && i < scans; ++i) {
    if (profile == TargetProfile::kWalk)
      target = std::clamp(target * std::exp(step(random)), o.min_bps, o.max_bps);
    else if (i % kJumpEvery == 0)
      target = std::exp(anywhere(random));
    targets[i] = target;
  }
  return targets;
}

std::vector<double> ReadTargets(const std::string& path, double scans_per_second) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot open " + path);
  std::vector<double> targets;
  double held = 0;
  std::string text;
  for (std::size_t number = 1; std::getline(file, text); ++number) {
    std::istringstream line(text.substr(0, text.find('#')));
    double time_s = 0;
    double mbps = 0;
    if (!(line >> time_s)) continue;
    if (!(line >> mbps) || !(mbps > 0))
      throw std::runtime_error(path + ": line " + std::to_string(number) +
                               " is not 'time_s rate_mbps'");
    while (held > 0 && static_cast<double>(targets.size()) / scans_per_second < time_s)
      targets.push_back(held);
    held = 1e6 * mbps;
  }
  if (held <= 0) throw std::runtime_error(path + ": has no target");
  targets.push_back(held);
  return targets;
}

rate::RateBounds MeasureBounds(const ScanSet& set, const TrackOptions& o, std::size_t scan) {
  SliceCodec codec;
  codec.Load(set.scans[scan], {});
  const rate::SettingLimits limits = Parameters(o, &codec).limits;
  const auto bitrate = [&](double step_m, unsigned bits) {
    double sum = 0;
    for (std::uint32_t i = 0; i < o.slices; ++i) {
      codec.Load(set.scans[scan], {i, o.slices});
      const auto encoded = codec.Encode(*o.mode, {step_m, bits, limits.level});
      if (encoded) sum += encoded->size.bits();
    }
    return DataRate::BitsPerSecond(sum * set.scans_per_second);
  };
  const unsigned least =
      std::min(o.intensity_bits, rate::ControllerParameters().min_intensity_bits);
  return {bitrate(limits.coarsest_step_m, least), bitrate(limits.coarsest_step_m, o.intensity_bits),
          bitrate(limits.finest_step_m, o.intensity_bits)};
}

double MinimumError(const ScanSet& set, const TrackOptions& o,
                    const std::vector<TrackedScan>& scans, std::size_t settle) {
  std::vector<double> minima;
  for (std::size_t i = 0; i < set.scans.size(); ++i)
    minima.push_back(MeasureBounds(set, o, i).min.bits_per_second());
  double sum = 0;
  std::size_t sent = 0;
  for (std::size_t i = settle; i < scans.size(); ++i) {
    if (scans[i].skipped) continue;
    sum += std::abs(scans[i].min_bps / minima[ThereAndBack(i, minima.size())] - 1);
    ++sent;
  }
  return sent > 0 ? sum / static_cast<double>(sent) : 0;
}

std::vector<TrackedScan> Track(const ScanSet& set, const std::vector<double>& targets,
                               const TrackOptions& o, std::unique_ptr<rate::SizeModel> model) {
  SliceCodec codec;
  codec.Load(set.scans.front(), {});
  rate::RateController controller(Parameters(o, &codec), std::move(model));
  Player player{set, o, controller, std::move(codec)};
  std::vector<TrackedScan> tracked(targets.size());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Scan& scan = set.scans[ThereAndBack(i, set.scans.size())];
    tracked[i].target_bps = targets[i];
    controller.SetTarget(DataRate::BitsPerSecond(targets[i]));
    for (std::uint32_t k = 0; k < o.slices; ++k) {
      player.codec.Load(scan, {k, o.slices});
      player.Slice(static_cast<std::uint32_t>(i), k, &tracked[i]);
    }
    tracked[i].min_bps = controller.bounds().min.bits_per_second();
  }
  return tracked;
}

TrackSummary Summarise(const std::vector<TrackedScan>& scans, std::size_t settle,
                       std::uint32_t slices) {
  TrackSummary summary;
  std::vector<double> errors;
  for (std::size_t i = settle; i < scans.size(); ++i) {
    errors.push_back(std::abs(scans[i].Error()));
    summary.mean += errors.back();
    summary.largest_over = std::max(summary.largest_over, scans[i].Error());
    summary.reencoded += scans[i].reencoded;
    summary.skipped += scans[i].skipped ? 1U : 0U;
    summary.largest_bound_m = std::max(summary.largest_bound_m, scans[i].largest_bound_m);
  }
  if (errors.empty()) return summary;
  std::sort(errors.begin(), errors.end());
  summary.mean /= static_cast<double>(errors.size());
  summary.percentile_95 = errors[(errors.size() - 1) * 95 / 100];
  summary.reencoded /= static_cast<double>(errors.size() * std::size_t{slices});
  return summary;
}

}  // namespace lidar::tools
