// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/rate_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "src/rate/model_file.h"
#include "src/sim/synthetic_codec.h"

namespace lidar::rate {
namespace {

using Targets = std::function<double(std::uint32_t scan)>;  // the target of a scan in bit/s

struct Scan {
  double budget = 0;
  double bytes = 0;
  bool skipped = false;
  double keep = 1;
  double coarsest_step = 0;
  unsigned intensity_bits = 0;
  double Error() const { return bytes / budget - 1; }
};

ControllerParameters Parameters() {
  ControllerParameters p;
  p.limits.finest_step_m = 0.001;
  p.limits.coarsest_step_m = 0.04;
  return p;
}

struct Stream {
  SyntheticCodec codec;
  RateController controller;
  SyntheticCodec::Parameters p;

  explicit Stream(SyntheticCodec::Parameters codec_parameters,
                  ControllerParameters parameters = Parameters())
      : codec(codec_parameters),
        controller(parameters, MakeBuiltInModel(RateModel::kAdaptive)),
        p(codec_parameters) {}

  Scan One(std::uint32_t id, double target) {
    Scan scan;
    controller.SetTarget(DataRate::BitsPerSecond(target));
    scan.budget = target / 8 / p.scans_per_second;
    for (std::uint32_t i = 0; i < p.slices; ++i) {
      const SliceFeatures f = codec.Features(id, i);
      const Decision d = controller.NextSlice(f);
      scan.skipped = d.skip;
      scan.keep = d.keep_fraction;
      scan.intensity_bits = d.settings.intensity_bits;
      if (d.skip) continue;
      Settings settings = d.settings;
      EncodedSize encoded = codec.Encode(f, settings, d.keep_fraction);
      if (const auto again = controller.OnEncoded(encoded)) {
        settings = *again;
        encoded = codec.Encode(f, settings, d.keep_fraction);
        EXPECT_FALSE(controller.OnEncoded(encoded)) << "only one second try";
      }
      scan.bytes += static_cast<double>(encoded.size.bytes());
      scan.coarsest_step = std::max(scan.coarsest_step, settings.step_m);
    }
    return scan;
  }

  /// Runs the controller at its minimum bitrate, and returns the minimum that the controller
  /// reports afterwards.
  double Minimum() {
    Many(5, [](auto) { return 4e6; });
    for (std::uint32_t i = 5; i < 25; ++i) One(i, controller.bounds().min.bits_per_second());
    return controller.bounds().min.bits_per_second();
  }

  std::vector<Scan> Many(std::uint32_t scans, const Targets& target) {
    std::vector<Scan> result;
    for (std::uint32_t i = 0; i < scans; ++i) result.push_back(One(i, target(i)));
    return result;
  }
};

std::vector<double> Errors(const std::vector<Scan>& scans, std::size_t from) {
  std::vector<double> errors;
  for (std::size_t i = from; i < scans.size(); ++i) errors.push_back(std::abs(scans[i].Error()));
  std::sort(errors.begin(), errors.end());
  return errors;
}
double Mean(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}
double Percentile95(const std::vector<double>& sorted) { return sorted[sorted.size() * 95 / 100]; }

class Tracking : public ::testing::TestWithParam<std::uint32_t> {  // slices per scan
 protected:
  static SyntheticCodec::Parameters Codec() {
    SyntheticCodec::Parameters p;
    p.slices = GetParam();
    return p;
  }
  /// Returns a scene whose minimum bitrate does not change.
  static SyntheticCodec::Parameters StandingCodec() {
    SyntheticCodec::Parameters p = Codec();
    p.drift = 0;
    return p;
  }
};

TEST_P(Tracking, HoldsASteadyTargetWithinOnePercent) {
  Stream run(Codec());
  const auto errors = Errors(run.Many(300, [](auto) { return 4e6; }), 5);
  EXPECT_LE(Mean(errors), 0.01);
  EXPECT_LE(Percentile95(errors), 0.05);
}

TEST_P(Tracking, FollowsARandomWalkOfEightPercentWithinTwo) {
  Stream run(Codec());
  std::mt19937 random(7);
  std::normal_distribution<double> step(0, 0.08);
  double target = 4e6;
  const auto errors = Errors(run.Many(300,
                                      [&](auto) {
                                        target *= std::exp(step(random));
                                        return target = std::clamp(target, 2.4e6, 8e6);
                                      }),
                             5);
  EXPECT_LE(Mean(errors), 0.02);
}

TEST_P(Tracking, NoScanPassesElevenTenthsOfItsBudgetAfterAJump) {
  Stream run(Codec());
  const auto scans = run.Many(200, [](auto scan) { return scan / 10 % 2 == 0 ? 6e6 : 2.4e6; });
  for (std::size_t i = 1; i < scans.size(); ++i) EXPECT_LE(scans[i].Error(), 0.10) << "scan " << i;
  EXPECT_LE(Mean(Errors(scans, 1)), 0.03);
}

TEST_P(Tracking, NeverPassesTheErrorBoundWhateverTheTarget) {
  Stream run(Codec());
  std::mt19937 random(9);
  std::uniform_real_distribution<double> exponent(0, 9.6);
  for (const Scan& scan : run.Many(300, [&](auto) { return std::pow(10, exponent(random)); }))
    EXPECT_LE(scan.coarsest_step, 0.04);
}

TEST_P(Tracking, SkipsWholeScansEvenlyBelowTheMinimumAndStillKeepsTheRate) {
  Stream run(StandingCodec());
  const double minimum = run.Minimum();
  double sent = 0;
  std::uint32_t skipped = 0;
  std::uint32_t gap = 0;
  std::uint32_t longest = 0;
  constexpr std::uint32_t kScans = 200;
  for (std::uint32_t i = 0; i < kScans; ++i) {
    const Scan scan = run.One(25 + i, 0.4 * minimum);
    sent += scan.bytes;
    skipped += scan.skipped;
    gap = scan.skipped ? gap + 1 : 0;
    longest = std::max(longest, gap);
  }
  EXPECT_NEAR(skipped, 0.6 * kScans, 0.02 * kScans);
  EXPECT_LE(longest, 2U);
  EXPECT_NEAR(sent / (kScans * 0.4 * minimum / 80), 1, 0.02);
  EXPECT_EQ(run.controller.stats().scans_thinned, 0U);
}

TEST_P(Tracking, ThinsEveryScanWhereTheFramerateIsToBeKept) {
  ControllerParameters parameters = Parameters();
  parameters.degradation = DegradationPreference::kMaintainFramerate;
  Stream run(StandingCodec(), parameters);
  const double minimum = run.Minimum();
  double sent = 0;
  constexpr std::uint32_t kScans = 200;
  for (std::uint32_t i = 0; i < kScans; ++i) {
    const Scan scan = run.One(25 + i, 0.4 * minimum);
    EXPECT_FALSE(scan.skipped);
    EXPECT_LT(scan.keep, 0.6);
    EXPECT_LE(scan.coarsest_step, 0.04);
    sent += scan.bytes;
  }
  EXPECT_NEAR(sent / (kScans * 0.4 * minimum / 80), 1, 0.02);
  EXPECT_GE(run.controller.stats().scans_thinned, kScans);
  EXPECT_LT(run.controller.stats().scans_thinned, kScans + 25U);
  EXPECT_EQ(run.controller.stats().scans_skipped, 0U);
}

TEST_P(Tracking, BalancedThinsAndSkipsAlike) {
  ControllerParameters parameters = Parameters();
  parameters.degradation = DegradationPreference::kBalanced;
  Stream run(StandingCodec(), parameters);
  const double minimum = run.Minimum();
  std::uint32_t skipped = 0;
  double sent = 0;
  constexpr std::uint32_t kScans = 200;
  for (std::uint32_t i = 0; i < kScans; ++i) {
    const Scan scan = run.One(25 + i, 0.36 * minimum);
    skipped += scan.skipped;
    EXPECT_NEAR(scan.keep, 0.6, 0.04);
    sent += scan.bytes;
  }
  EXPECT_NEAR(skipped, 0.45 * kScans, 0.06 * kScans);
  EXPECT_GE(run.controller.stats().scans_skipped, skipped);
  EXPECT_LE(run.controller.stats().scans_skipped + run.controller.stats().scans_thinned,
            kScans + 25U);
  EXPECT_NEAR(sent / (kScans * 0.36 * minimum / 80), 1, 0.03);
}

TEST_P(Tracking, ComesBackToEveryScanAtOnceWhenTheTargetDoes) {
  Stream run(Codec());
  run.Many(40, [](auto scan) { return scan < 20 ? 4e6 : 3e5; });
  for (std::uint32_t i = 40; i < 60; ++i) {
    const Scan scan = run.One(i, 4e6);
    EXPECT_FALSE(scan.skipped);
    EXPECT_LE(scan.Error(), 0.10);
  }
}

class Ramps : public ::testing::TestWithParam<std::tuple<DegradationPreference, std::uint32_t>> {};

/// The target falls to 7 % of the minimum and rises again, by 3 % per scan.
TEST_P(Ramps, GoBelowTheMinimumAndComeBackWithoutAJolt) {
  const auto [preference, slices] = GetParam();
  ControllerParameters parameters = Parameters();
  parameters.degradation = preference;
  SyntheticCodec::Parameters codec;
  codec.slices = slices;
  Stream run(codec, parameters);
  const double minimum = run.Minimum();
  double lead = 0;  // bytes that were sent beyond the budgets so far
  double keep = 1;
  std::uint32_t gap = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const double share = 1.5 * std::pow(0.97, std::min(i, 199 - i));
    const Scan scan = run.One(25 + i, share * minimum);
    EXPECT_LE(scan.coarsest_step, 0.04);
    if (!scan.skipped) {
      EXPECT_NEAR(scan.keep, keep, 0.1) << i;
      keep = scan.keep;
    }
    gap = scan.skipped ? gap + 1 : 0;
    EXPECT_LE(gap, std::ceil(1.2 / std::min(1.0, share))) << i;
    EXPECT_FALSE(share > 1.1 && (scan.keep < 1 || scan.skipped)) << i;
    lead += scan.bytes - scan.budget;
    EXPECT_LE(lead, 1.1 * minimum / 80) << i;
    EXPECT_GE(lead, -1.1 * minimum / 80) << i;
  }
  EXPECT_EQ(keep, 1);
}
INSTANTIATE_TEST_SUITE_P(
    All, Ramps,
    ::testing::Combine(::testing::Values(DegradationPreference::kMaintainAccuracy,
                                         DegradationPreference::kMaintainFramerate,
                                         DegradationPreference::kBalanced),
                       ::testing::Values(1U, 8U)));

/// The controller must predict the minimum: the run never uses the coarsest step, and the sizes of
/// the codec follow another curve than the model.
TEST_P(Tracking, KnowsTheMinimumWithoutEverHavingBeenThere) {
  Stream run(Codec());
  for (std::uint32_t i = 0; i < 100; ++i) {
    run.One(i, 4e6);
    double real = 0;
    for (std::uint32_t k = 0; k < run.p.slices; ++k) {
      const SliceFeatures f = run.codec.Features(i, k);
      real += run.codec.Encode(f, {0.04, 0, 0}).size.bits() * run.p.scans_per_second;
    }
    if (i < 3) continue;
    EXPECT_NEAR(run.controller.bounds().min.bits_per_second() / real, 1, 0.12) << i;
  }
}

/// If the target falls to the minimum within a scan, the minimum must be known before the next scan
/// begins.
TEST_P(Tracking, TellsTheMinimumAfterTheLastSliceOfEachScan) {
  Stream run(Codec());
  double told = 0;
  for (std::uint32_t i = 0; i < 20; ++i) {
    for (std::uint32_t k = 0; k < run.p.slices; ++k) {
      const bool low = i > 10 || (i == 10 && 2 * k >= run.p.slices);
      run.controller.SetTarget(DataRate::BitsPerSecond(low ? 1.05 * told : 4e6));
      const SliceFeatures f = run.codec.Features(i, k);
      const Decision d = run.controller.NextSlice(f);
      EXPECT_FALSE(d.skip) << i;
      if (d.skip) continue;
      EncodedSize encoded = run.codec.Encode(f, d.settings, d.keep_fraction);
      if (const auto again = run.controller.OnEncoded(encoded))
        run.controller.OnEncoded(run.codec.Encode(f, *again, d.keep_fraction));
      if (const auto bounds = run.controller.TakeChangedBounds())
        told = bounds->min.bits_per_second();
    }
    EXPECT_NEAR(told / run.controller.bounds().min.bits_per_second(), 1, 0.031) << i;
  }
}

TEST_P(Tracking, LowersTheIntensityBeforeItSkips) {
  ControllerParameters parameters = Parameters();
  parameters.limits.intensity_bits = 8;
  Stream run(StandingCodec(), parameters);
  run.Many(5, [](auto) { return 8e6; });
  const RateBounds bounds = run.controller.bounds();
  EXPECT_LT(bounds.min, bounds.nominal);
  EXPECT_LT(bounds.nominal, bounds.max);
  const double between = (bounds.min.bits_per_second() + bounds.nominal.bits_per_second()) / 2;
  unsigned bits = 0;
  for (std::uint32_t i = 5; i < 100; ++i) {
    const Scan scan = run.One(i, between);
    EXPECT_FALSE(scan.skipped) << i;
    bits = scan.intensity_bits;
  }
  EXPECT_LT(bits, 8U);
  EXPECT_GE(bits, 4U);
}

TEST(RateController, TellsOfBoundsOfWhichOnlyTheMaximumHasMoved) {
  SyntheticCodec::Parameters standing;
  standing.drift = 0;
  Stream run(standing);
  for (std::uint32_t i = 0; i < 30; ++i) run.One(i, 4e6);
  while (run.controller.TakeChangedBounds()) {
  }
  const RateBounds before = run.controller.bounds();
  ControllerParameters finer = Parameters();
  finer.limits.finest_step_m /= 4;
  run.controller.SetParameters(finer);
  run.One(30, 4e6);
  const auto told = run.controller.TakeChangedBounds();
  ASSERT_TRUE(told);
  EXPECT_GT(told->max.bits_per_second(), 1.1 * before.max.bits_per_second());
  EXPECT_NEAR(told->min / before.min, 1, 0.03);
  EXPECT_NEAR(told->nominal / before.nominal, 1, 0.03);
}

TEST(RateController, SpendsWhatSlicesWithoutReturnsLeave) {
  SyntheticCodec::Parameters p;
  p.noise = 0;
  p.drift = 0;
  Stream run(p);
  for (std::uint32_t scan = 0; scan < 20; ++scan) {
    run.controller.SetTarget(DataRate::BitsPerSecond(2e6));
    double bytes = 0;
    for (std::uint32_t i = 0; i < 8; ++i) {
      SliceFeatures f = run.codec.Features(scan, i);
      const bool in_window = i >= 2 && i < 5;
      if (!in_window) f.returns = 0;
      const Decision d = run.controller.NextSlice(f);
      if (!in_window) continue;
      EncodedSize encoded = run.codec.Encode(f, d.settings);
      if (const auto again = run.controller.OnEncoded(encoded)) {
        encoded = run.codec.Encode(f, *again);
        run.controller.OnEncoded(encoded);
      }
      bytes += static_cast<double>(encoded.size.bytes());
    }
    if (scan < 3) continue;
    EXPECT_NEAR(bytes / 25'000, 1, 0.02) << scan;
  }
}

TEST(RateController, PaysBackHalfOfADebtWithEachScan) {
  SyntheticCodec::Parameters p;
  p.slices = 1;
  p.noise = p.drift = 0;
  Stream run(p);
  run.Many(50, [](auto) { return 4e6; });
  const double share = 4e6 / 8 / p.scans_per_second;
  const double owed = 0.2 * share;
  const Decision decision = run.controller.NextSlice(run.codec.Features(50, 0));
  EncodedSize too_large;
  too_large.size = DataSize::Bytes(static_cast<std::int64_t>(share + owed));
  too_large.step_m = decision.settings.step_m;
  if (run.controller.OnEncoded(too_large)) run.controller.OnEncoded(too_large);
  const Decision next = run.controller.NextSlice(run.codec.Features(51, 0));
  ASSERT_TRUE(next.budget);
  EXPECT_NEAR(static_cast<double>(next.budget->bytes()), share - 0.5 * owed, 0.02 * share);
}

TEST(RateController, OwesNothingBehindScansWithoutATarget) {
  SyntheticCodec::Parameters p;
  p.slices = 1;
  p.noise = p.drift = 0;
  Stream run(p);
  run.Many(5, [](auto) { return 4e6; });
  const double share = 4e6 / 8 / p.scans_per_second;
  EncodedSize encoded;
  encoded.step_m = run.controller.NextSlice(run.codec.Features(5, 0)).settings.step_m;
  encoded.size = DataSize::Bytes(static_cast<std::int64_t>(1.2 * share));
  if (run.controller.OnEncoded(encoded)) run.controller.OnEncoded(encoded);
  run.controller.SetTarget(std::nullopt);
  for (std::uint32_t scan = 6; scan < 8; ++scan) {
    const SliceFeatures f = run.codec.Features(scan, 0);
    run.controller.OnEncoded(run.codec.Encode(f, run.controller.NextSlice(f).settings));
  }
  run.controller.SetTarget(DataRate::BitsPerSecond(4e6));
  const Decision decision = run.controller.NextSlice(run.codec.Features(8, 0));
  ASSERT_TRUE(decision.budget);
  EXPECT_NEAR(static_cast<double>(decision.budget->bytes()) / share, 1, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Slices, Tracking, ::testing::Values(1U, 2U, 8U, 16U));

}  // namespace
}  // namespace lidar::rate
