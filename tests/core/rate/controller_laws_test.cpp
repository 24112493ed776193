// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests laws that hold for any model, target and scene. The model of these tests predicts exact
// sizes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "src/rate/adaptive_model.h"
#include "src/rate/paper_model.h"
#include "src/rate/rate_controller.h"
#include "src/rate/rate_loop.h"

namespace lidar::rate {
namespace {

/// A model in which a return takes one byte at a step of 1 cm, and an eighth of a byte for each bit
/// of its intensity.
class ExactModel : public SizeModel {
 public:
  PredictedSize Predict(const SliceFeatures& slice, const Settings& settings) const override {
    return {slice.returns * std::sqrt(0.01 / settings.step_m),
            slice.returns * settings.intensity_bits / 8.0};
  }
  Settings Choose(const SliceFeatures& slice, double bytes,
                  const SettingLimits& limits) const override {
    const double geometry = bytes - slice.returns * limits.intensity_bits / 8.0;
    const double root = geometry > 0 ? slice.returns / geometry : 1e9;
    return {std::clamp(0.01 * root * root, limits.finest_step_m, limits.coarsest_step_m),
            limits.intensity_bits, limits.level};
  }
  void OnEncoded(const SliceFeatures&, const Settings&, const EncodedSize&) override {}
};

constexpr std::uint32_t kSlicesOfScan = 4;
constexpr double kScanBytes = 4'000;  // the target, per scan

ControllerParameters WithoutIntensity() {
  ControllerParameters p;
  p.limits.finest_step_m = 0.001;
  p.limits.coarsest_step_m = 0.04;  // At this step, a return takes half a byte.
  p.min_intensity_bits = 0;
  return p;
}

class Accounts : public ::testing::Test {
 protected:
  Accounts() { controller_.SetTarget(DataRate::BitsPerSecond(kScanBytes * 8 * 10)); }
  static SliceFeatures Features(std::uint32_t scan, std::uint32_t index,
                                std::uint32_t returns = 500) {
    SliceFeatures f;
    f.scan_id = scan;
    f.slice_index = index;
    f.slice_count = kSlicesOfScan;
    f.returns = returns;
    f.mode = "range-exact";
    return f;
  }
  std::optional<Settings> Encoded(double bytes, double step_m) {
    return controller_.OnEncoded({DataSize::Bytes(static_cast<std::int64_t>(bytes)), step_m, 1});
  }
  RateController controller_{WithoutIntensity(), std::make_unique<ExactModel>()};
};

TEST_F(Accounts, SayWhatTheTargetGaveLessWhatWasSent) {
  std::mt19937 random(3);
  // The error is too small for a second try.
  std::uniform_real_distribution<double> off(0.99, 1.01);
  double given = 0;
  double sent = 0;
  for (std::uint32_t scan = 0; scan < 50; ++scan)
    for (std::uint32_t i = 0; i < kSlicesOfScan; ++i) {
      const Decision d = controller_.NextSlice(Features(scan, i));
      ASSERT_TRUE(d.budget);
      given += kScanBytes / kSlicesOfScan;
      const double bytes = std::floor(static_cast<double>(d.budget->bytes()) * off(random));
      EXPECT_FALSE(Encoded(bytes, d.settings.step_m));
      sent += bytes;
      EXPECT_NEAR(controller_.stats().saved_bytes, given - sent, 1e-6);
    }
  EXPECT_EQ(controller_.stats().slices, 50 * kSlicesOfScan);
  EXPECT_EQ(controller_.stats().slices_reencoded, 0U);
  EXPECT_NEAR(sent / given, 1, 0.01);
}

/// The first scans are slightly larger than their targets, so that the later scans begin with a
/// debt.
TEST_F(Accounts, SayTheSameWhereTheTargetFallsBelowWhatIsNeeded) {
  double given = 0;
  double sent = 0;
  for (std::uint32_t scan = 0; scan < 12; ++scan) {
    const double target = scan < 2 ? kScanBytes : 500;  // A scan needs 1,000 bytes.
    controller_.SetTarget(DataRate::BitsPerSecond(target * 8 * 10));
    for (std::uint32_t i = 0; i < kSlicesOfScan; ++i) {
      const Decision d = controller_.NextSlice(Features(scan, i));
      given += target / kSlicesOfScan;
      if (!d.skip) {
        const double bytes =
            d.budget ? std::floor(1.01 * static_cast<double>(d.budget->bytes())) : 250;
        EXPECT_FALSE(Encoded(bytes, d.settings.step_m));
        sent += bytes;
      }
      EXPECT_NEAR(controller_.stats().saved_bytes, given - sent, 1e-6) << scan;
    }
  }
  EXPECT_GT(controller_.stats().scans_skipped, 2U);
}

TEST_F(Accounts, ASecondTryIsForWhatMissesItsBudgetByMuchAndGoesTheRightWay) {
  std::uint32_t scan = 0;
  std::uint64_t tries = 0;
  for (const double part : {0.1, 0.5, 0.9, 0.97, 1.0, 1.005, 1.05, 1.5, 4.0}) {
    const Decision d = controller_.NextSlice(Features(scan++, 0, 2'000));
    ASSERT_TRUE(d.budget);
    const auto budget = static_cast<double>(d.budget->bytes());
    // At this step, the size of the slice is `part` of its budget.
    const double step = 0.004;
    const auto again = Encoded(part * budget, step);
    const double tolerance = std::max(0.015 * budget, 0.01 * kScanBytes);
    const bool misses =
        part * budget > budget + tolerance || part * budget < budget - 3 * tolerance;
    EXPECT_EQ(again.has_value(), misses) << part;
    if (again) {
      ++tries;
      const double aim = 2'000 * std::sqrt(0.01 / again->step_m);
      EXPECT_LE(aim, budget + 1) << "rather too little than too much";
      EXPECT_GE(aim, 0.9 * budget);
      EXPECT_FALSE(Encoded(budget, again->step_m)) << "only one";
    }
    EXPECT_EQ(controller_.stats().slices_reencoded, tries);
  }
  EXPECT_GE(tries, 4U);
}

TEST_F(Accounts, BoundsAreToldAfterAScanWhoseLastSliceWasNotCoded) {
  for (std::uint32_t scan = 0; scan < 2; ++scan)
    for (std::uint32_t i = 0; i < kSlicesOfScan; ++i) {
      const Decision d = controller_.NextSlice(Features(scan, i));
      if (scan == 1) {
        EXPECT_EQ(controller_.TakeChangedBounds().has_value(), i == 0);
        continue;
      }
      if (i + 1 < kSlicesOfScan) Encoded(500, d.settings.step_m);
    }
}

// If the number of bits changed with each scan, the intensities of a still scene would flicker.
TEST_F(Accounts, IntensityBitsRiseAgainOnlyWithAMargin) {
  ControllerParameters p = WithoutIntensity();
  p.limits.intensity_bits = 8;
  controller_.SetParameters(p);
  // A scan needs 1,000 bytes, and 250 more bytes for each bit of intensity.
  struct Step {
    double bytes;
    unsigned bits;
  };
  std::uint32_t scan = 0;
  for (const Step& step : {Step{1'990, 3}, Step{2'010, 3}, Step{2'210, 3}, Step{2'240, 4},
                           Step{2'010, 4}, Step{1'990, 3}, Step{9'000, 8}}) {
    controller_.SetTarget(DataRate::BitsPerSecond(step.bytes * 8 * 10));
    for (std::uint32_t i = 0; i < kSlicesOfScan; ++i) {
      const Decision d = controller_.NextSlice(Features(scan, i));
      EXPECT_EQ(d.settings.intensity_bits, step.bits) << step.bytes;
      Encoded(d.budget ? static_cast<double>(d.budget->bytes()) : 1, d.settings.step_m);
    }
    ++scan;
  }
}

TEST_F(Accounts, ASecondTryHasTheIntensityBitsOfItsScan) {
  ControllerParameters p = WithoutIntensity();
  p.limits.intensity_bits = 8;
  controller_.SetParameters(p);
  controller_.SetTarget(DataRate::BitsPerSecond(1'990 * 8 * 10));
  const Decision d = controller_.NextSlice(Features(0, 0));
  ASSERT_TRUE(d.budget);
  EXPECT_EQ(d.settings.intensity_bits, 3U);
  const auto again = Encoded(3 * static_cast<double>(d.budget->bytes()), 0.004);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->intensity_bits, 3U);
}

TEST_F(Accounts, WithoutTheLoopEachSliceGetsItsShareWhateverWasSent) {
  ControllerParameters open = WithoutIntensity();
  open.closed_loop = false;
  controller_.SetParameters(open);
  for (std::uint32_t scan = 0; scan < 5; ++scan)
    for (std::uint32_t i = 0; i < kSlicesOfScan; ++i) {
      const Decision d = controller_.NextSlice(Features(scan, i, 100 + 400 * i));
      ASSERT_TRUE(d.budget);
      EXPECT_FALSE(d.skip);
      EXPECT_EQ(d.budget->bytes(), 1'000);
      EXPECT_FALSE(Encoded(scan % 2 == 0 ? 5'000 : 10, d.settings.step_m)) << "no second try";
    }
}

/// The targets rise from far below the minimum to far above it. This is repeated for each
/// preference.
TEST(CountersOfScans, AreWhatWasDecided) {
  for (const auto preference :
       {DegradationPreference::kMaintainAccuracy, DegradationPreference::kMaintainFramerate,
        DegradationPreference::kBalanced}) {
    ControllerParameters p = WithoutIntensity();
    p.degradation = preference;
    RateController controller(p, std::make_unique<ExactModel>());
    std::uint64_t slices_skipped = 0;
    std::uint64_t scans_skipped = 0;
    std::uint64_t scans_thinned = 0;
    for (std::uint32_t scan = 0; scan < 60; ++scan) {
      controller.SetTarget(DataRate::BitsPerSecond(2'000 * (1 + scan * scan)));
      for (std::uint32_t i = 0; i < kSlicesOfScan; ++i) {
        SliceFeatures f;
        f.scan_id = scan;
        f.slice_index = i;
        f.slice_count = kSlicesOfScan;
        f.returns = 5'000;
        const Decision d = controller.NextSlice(f);
        slices_skipped += d.skip ? 1 : 0;
        if (i == 0) scans_skipped += d.skip ? 1 : 0;
        if (i == 0 && !d.skip) scans_thinned += d.keep_fraction < 1 ? 1 : 0;
        if (d.skip) continue;
        const double bytes = 5'000 * d.keep_fraction * std::sqrt(0.01 / d.settings.step_m);
        controller.OnEncoded({DataSize::Bytes(static_cast<std::int64_t>(bytes)), d.settings.step_m,
                              d.keep_fraction});
      }
    }
    EXPECT_EQ(controller.stats().slices_skipped, slices_skipped);
    EXPECT_EQ(controller.stats().scans_skipped, scans_skipped);
    EXPECT_EQ(controller.stats().scans_thinned, scans_thinned);
    EXPECT_EQ(controller.stats().slices, 60 * kSlicesOfScan);
    EXPECT_GT(scans_skipped + scans_thinned, 5U);
  }
}

class BoundsOfRates : public ::testing::TestWithParam<double> {};  // scans per second
INSTANTIATE_TEST_SUITE_P(All, BoundsOfRates, ::testing::Values(5.0, 10.0, 20.0));

TEST_P(BoundsOfRates, AreWhatAScanTakesAtItsLimitsAndAreToldOnce) {
  ControllerParameters p = WithoutIntensity();
  p.limits.intensity_bits = 8;
  p.min_intensity_bits = 4;
  RateController controller(p, std::make_unique<ExactModel>());
  int told = 0;
  for (std::uint32_t scan = 0; scan < 10; ++scan)
    for (std::uint32_t i = 0; i < kSlicesOfScan; ++i) {
      SliceFeatures f;
      f.scan_id = scan;
      f.slice_index = i;
      f.slice_count = kSlicesOfScan;
      f.scans_per_second = GetParam();
      f.returns = 5'000;
      controller.NextSlice(f);
      controller.OnEncoded({DataSize::Bytes(5'000), 0.04, 1});
      if (controller.TakeChangedBounds()) ++told;
    }
  EXPECT_EQ(told, 1) << "a scene that stands still";
  const double rate = 8 * GetParam() * kSlicesOfScan * 5'000;
  const RateBounds bounds = controller.bounds();
  EXPECT_NEAR(bounds.min.bits_per_second(), rate * (0.5 + 0.5), 1);
  EXPECT_NEAR(bounds.nominal.bits_per_second(), rate * (0.5 + 1), 1);
  EXPECT_NEAR(bounds.max.bits_per_second(), rate * (std::sqrt(10) + 1), 1);
}

TEST(ScanPlans, KeepTheIntensityBetweenItsLimitsAtAnyBudget) {
  for (unsigned most = 0; most <= 8; ++most)
    for (unsigned least = 0; least <= 10; ++least)
      for (double budget = 1; budget < 300; budget *= 1.5)
        for (const unsigned last : {0U, least, most}) {
          ScanPlanInputs in;
          in.needed.coarsest = 60;
          for (unsigned bits = 0; bits < in.needed.intensity.size(); ++bits)
            in.needed.intensity[bits] = 10.0 * bits;
          in.budget = budget;
          in.measured = true;
          in.intensity_bits = most;
          in.min_intensity_bits = least;
          in.last_intensity_bits = last;
          const ScanPlan plan = PlanScan(in, DegradationPreference::kMaintainAccuracy);
          EXPECT_LE(plan.intensity_bits, most);
          EXPECT_GE(plan.intensity_bits, std::min(least, most));
          const bool fits = in.needed.AtCoarsest(plan.intensity_bits) <= budget;
          EXPECT_TRUE(fits || plan.intensity_bits == std::min(least, most));
          EXPECT_EQ(plan.degraded, !fits);
        }
}

/// A coder that records its settings. Its slices have no intensity.
class RangesOnly : public SliceCoder {
 public:
  LoadedSlice loaded() const override { return {1'000, 50, 32, false, 3, "range-plain"}; }
  StepRange Steps(double max_error_m) const override { return {0.001, 2 * max_error_m, 0}; }
  void Thin(const std::vector<bool>&) override {}
  CodingResult Encode(double, const Settings& settings, CodedSlice* slice) override {
    bits = settings.intensity_bits;
    level = settings.level;
    *slice = {1'000, 1'000, settings.step_m, settings.step_m / 2};
    return CodingResult::kEncoded;
  }
  unsigned bits = 99;
  unsigned level = 99;
};

TEST(LoopOfRanges, PlansNoIntensityWhereThereIsNone) {
  RateLoop loop(std::make_unique<ExactModel>());
  RangesOnly coder;
  LoopSettings settings;
  settings.intensity_bits = 8;
  for (std::uint32_t scan = 0; scan < 3; ++scan) {
    const LoopResult result =
        loop.Encode({scan, 0, 1, 10}, settings, DataRate::BitsPerSecond(8e4), &coder);
    EXPECT_EQ(coder.bits, 0U);
    EXPECT_EQ(result.intensity_bits, 0U);
  }
  const RateBounds bounds = loop.controller().bounds();
  EXPECT_EQ(bounds.min, bounds.nominal) << "no bits to leave out";
}

TEST(LoopOfRanges, AsksTheCoderForItsLevelAndPlansForItsRate) {
  for (const double scans_per_second : {5.0, 20.0}) {
    RateLoop loop(std::make_unique<ExactModel>());
    RangesOnly coder;
    loop.Encode({0, 0, 1, scans_per_second}, {}, std::nullopt, &coder);
    EXPECT_EQ(coder.level, 3U);
    EXPECT_NEAR(loop.controller().bounds().nominal.bits_per_second(),
                8 * scans_per_second * 1'000 * std::sqrt(0.01 / 0.04), 1);
    loop.Encode({1, 0, 1, scans_per_second}, {}, DataRate::BitsPerSecond(1e5), &coder);
    EXPECT_EQ(coder.level, 3U);
  }
}

TEST(TrackersOfSlices, AnotherNumberOfSlicesReplacesNoneOfThese) {
  SliceTracker tracker;
  for (std::uint32_t i = 0; i < 4; ++i) tracker.Observe(i, 4, {1, 10.0 + i}, 0);
  for (const std::uint32_t count : {2U, 3U, 8U}) tracker.Replace(1, count, {5, 99});
  EXPECT_DOUBLE_EQ(tracker.Predict(1, 4)->residual, 11);
  tracker.Replace(1, 4, {5, 99});
  EXPECT_DOUBLE_EQ(tracker.Predict(1, 4)->residual, 99);
}

TEST(DemandTables, BeginAnewWithAnotherNumberOfSlices) {
  for (const std::uint32_t before : {2U, 3U, 8U}) {
    DemandTable used;
    for (std::uint32_t i = 0; i < before; ++i) used.Set(i, before, {100, 1'000, {}});
    DemandTable fresh;
    for (DemandTable* table : {&used, &fresh})
      for (const std::uint32_t i : {0U, 2U}) table->Set(i, 5, {4.0 + i, 40.0 + i, {0, 2}});
    for (std::uint32_t first = 0; first < 5; ++first) {
      EXPECT_DOUBLE_EQ(used.Sum(first).coarsest, fresh.Sum(first).coarsest);
      EXPECT_DOUBLE_EQ(used.Sum(first).finest, fresh.Sum(first).finest);
      EXPECT_DOUBLE_EQ(used.Sum(first).intensity[1], fresh.Sum(first).intensity[1]);
      EXPECT_DOUBLE_EQ(used.EvenShare(first, 50), fresh.EvenShare(first, 50));
    }
  }
}

/// The steps of the grid are so close to each other that several sizes are within a tenth of the
/// wanted size.
TEST(ChosenSteps, AreThoseOfTheNearestSizeThatIsNotFarAbove) {
  AdaptiveCoefficients c;
  c.fallback.step = {10, -0.5, 0, 0};
  const AdaptiveModel model(c);
  SliceFeatures slice;
  slice.returns = 1'000;
  SettingLimits limits;
  limits.finest_step_m = 0.02;
  limits.step_unit_m = 0.001;
  for (const double coarsest : {0.06, 0.0605}) {
    limits.coarsest_step_m = coarsest;
    for (double bytes = 300; bytes < 900; bytes += 7) {
      double best = 0.06;
      for (int i = 40; i >= 0; --i) {
        const double step = 0.02 + 0.001 * i;
        const double size = model.Predict(slice, {step, 0, 0}).total();
        const double least = model.Predict(slice, {best, 0, 0}).total();
        if (size <= 1.06 * bytes && std::abs(size - bytes) < std::abs(least - bytes)) best = step;
      }
      EXPECT_NEAR(model.Choose(slice, bytes, limits).step_m, best, 1e-9) << bytes;
    }
  }
}

/// Two coders of the same geometry encode in turns. They have the same coefficients.
TEST(ModesOfOneGeometry, LearnAsASingleOne) {
  const AdaptiveCoefficients c{{}, {{11, -0.5, 0, 0}, -3, 5, 1, {6, 1}, 1}};
  AdaptiveModel single(c);
  AdaptiveModel turns(c);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> size(1'000, 6'000);
  for (std::uint32_t scan = 0; scan < 40; ++scan)
    for (std::uint32_t i = 0; i < 4; ++i) {
      SliceFeatures slice;
      slice.scan_id = scan;
      slice.slice_index = i;
      slice.slice_count = 4;
      slice.returns = 3'000;
      slice.mode = "range-a";
      SliceFeatures other = slice;
      if (scan / 3 % 2 == 1) other.mode = "range-b";
      const Settings settings{scan % 2 == 0 ? 0.02 : 0.03, 4, 0};
      EXPECT_DOUBLE_EQ(single.Predict(slice, settings).total(),
                       turns.Predict(other, settings).total());
      const EncodedSize encoded{DataSize::Bytes(static_cast<std::int64_t>(size(random))),
                                settings.step_m, scan % 5 == 4 ? 0.5 : 1};
      single.OnEncoded(slice, settings, encoded);
      turns.OnEncoded(other, settings, encoded);
    }
}

TEST(LevelsOfThePaper, AreChosenForXyzOnly) {
  PaperPolynomial p;
  p.alpha[0] = 1'000;  // bytes = 1000 q - 100 c
  p.alpha[1] = -100;
  const PaperModel model({{{"xyz", p}, {"range", p}}});
  SettingLimits limits;
  limits.finest_step_m = 1e-5;
  limits.coarsest_step_m = 1;
  limits.level = 7;
  bool any_other = false;
  for (double bytes = 8'000; bytes < 20'000; bytes += 130) {
    SliceFeatures slice;
    slice.returns = 1'000;
    slice.extent_m = 100;
    slice.mode = "range-adaptive";
    EXPECT_EQ(model.Choose(slice, bytes, limits).level, 7U);
    slice.mode = "xyz-kd6";
    any_other = any_other || model.Choose(slice, bytes, limits).level != 7;
  }
  EXPECT_TRUE(any_other);
}

/// The polynomials are negative in parts, as a fit may be far from its samples.
TEST(ModelOfThePaper, StaysWithinTheLimitsAndPredictsNoNegativeSize) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> alpha(-500, 500);
  for (int n = 0; n < 200; ++n) {
    PaperPolynomial p;
    for (double& a : p.alpha) a = alpha(random);
    p.beta = alpha(random);
    const PaperModel model({{{"xyz", p}, {"range", p}}});
    SliceFeatures slice;
    slice.returns = 2'000;
    slice.extent_m = 60;
    slice.mode = n % 2 == 0 ? "xyz-kd6" : "range-adaptive";
    SettingLimits limits;
    limits.finest_step_m = 0.002;
    limits.coarsest_step_m = 0.08;
    const Settings chosen = model.Choose(slice, 10 * alpha(random), limits);
    EXPECT_GE(chosen.step_m, limits.finest_step_m);
    EXPECT_LE(chosen.step_m, limits.coarsest_step_m);
    for (const double step : {0.002, 0.01, 0.08})
      EXPECT_GE(model.Predict(slice, {step, 0, 7}).total(), 0);
  }
}

}  // namespace
}  // namespace lidar::rate
