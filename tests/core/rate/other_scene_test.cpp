// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the situation of the paper: a model that was trained in the tunnel is used in the street.
#include <gtest/gtest.h>

#include <cmath>

#include "src/rate/model_fit.h"
#include "src/tools/lab/codec_lab/measure.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "src/tools/lab/codec_lab/tracking.h"
#include "src/tools/lab/codec_lab/training.h"

namespace lidar::tools {
namespace {

constexpr std::size_t kScans = 12;
constexpr std::size_t kLength = 60;

class TrainedInTheTunnel : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    SourceOptions options;
    options.max_scans = kScans;
    sets_ = new Sets;
    sets_->tunnel = LoadScans("synth:os0-32:tunnel:512", options);
    sets_->street = LoadScans("synth:os0-32:street:512", options);
  }
  static void TearDownTestSuite() { delete sets_; }

  static SamplingOptions Sampling(std::vector<std::string> modes) {
    SamplingOptions sampling;
    sampling.samples = 60;
    sampling.modes = std::move(modes);
    sampling.intensity_bits = 0;
    sampling.slices = {1, 2, 4};
    return sampling;
  }
  static std::unique_ptr<rate::SizeModel> Adaptive(const std::string& mode) {
    const auto fit = rate::FitAdaptive(TakeSamples({sets_->tunnel}, Sampling({mode}), Quiet));
    return std::make_unique<rate::AdaptiveModel>(fit.value());
  }
  static void Quiet(double) {}

  struct Sets {
    ScanSet tunnel;
    ScanSet street;
  };
  static Sets* sets_;
};
TrainedInTheTunnel::Sets* TrainedInTheTunnel::sets_ = nullptr;

/// Returns the geometric mean of two rates: the rate that the error bound needs, and the highest
/// rate that is of use.
double MiddleRate(const ScanSet& set, const TrackOptions& options) {
  const rate::RateBounds bounds = MeasureBounds(set, options);
  return std::sqrt(bounds.min.bits_per_second() * bounds.max.bits_per_second());
}

TEST_F(TrainedInTheTunnel, AdaptiveHoldsASteadyTargetInTheStreet) {
  TrackOptions options;
  options.mode = &DefaultRangeMode();
  options.slices = 4;
  const double rate = MiddleRate(sets_->street, options);
  const auto scans = Track(sets_->street, std::vector<double>(kLength, rate), options,
                           Adaptive(DefaultRangeMode().name));
  const TrackSummary summary = Summarise(scans, 1, options.slices);
  EXPECT_LE(summary.mean, 0.01);
  EXPECT_LE(summary.percentile_95, 0.05);
  EXPECT_LE(summary.largest_over, 0.10);
  EXPECT_LE(summary.largest_bound_m, options.max_error_m);
}

TEST_F(TrainedInTheTunnel, AdaptiveKeepsJumpsInTheStreetBelowElevenTenths) {
  TrackOptions options;
  options.mode = &DefaultRangeMode();
  options.slices = 4;
  const rate::RateBounds bounds = MeasureBounds(sets_->street, options);
  ProfileOptions profile;
  profile.min_bps = 1.2 * bounds.min.bits_per_second();
  profile.max_bps = bounds.max.bits_per_second() / 1.2;
  const auto scans = Track(sets_->street, MakeTargets(TargetProfile::kJump, kLength, profile),
                           options, Adaptive(DefaultRangeMode().name));
  EXPECT_LE(Summarise(scans, 1, options.slices).largest_over, 0.10);
}

TEST_F(TrainedInTheTunnel, ThePapersPolynomialMissesWhereOursCorrectsItself) {
  TrackOptions options;
  options.mode = &ModeNamed("xyz-kd6");
  options.slices = 1;
  const std::vector<double> targets(kLength, MiddleRate(sets_->street, options));

  const auto ours = Track(sets_->street, targets, options, Adaptive("xyz-kd6"));
  options.open_loop = true;
  const auto fit = rate::FitPaper(TakePaperSamples({sets_->tunnel}, Sampling({"xyz-kd6"}), Quiet));
  const auto papers =
      Track(sets_->street, targets, options, std::make_unique<rate::PaperModel>(fit.value()));
  EXPECT_LE(Summarise(ours, 1, 1).mean, 0.015);
  EXPECT_GE(Summarise(papers, 1, 1).mean, 0.04);
  EXPECT_LE(Summarise(papers, 0, 1).largest_bound_m, options.max_error_m)
      << "a wrong prediction must not break the error bound";
}

}  // namespace
}  // namespace lidar::tools
