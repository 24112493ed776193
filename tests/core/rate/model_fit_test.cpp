// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/model_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "src/rate/adaptive_model.h"
#include "src/rate/model_file.h"

namespace lidar::rate {
namespace {

/// Returns samples with random settings, drawn as lidar-train draws them. `size` sets the bytes of
/// each sample.
template <class Size>
std::vector<Sample> Samples(std::size_t count, const Size& size) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> log_step(-9, -3.3);
  std::uniform_real_distribution<double> log_returns(11, 17);
  std::vector<Sample> samples(count);
  for (Sample& s : samples) {
    s.slice.mode = random() % 2 == 0 ? "range-adaptive" : "xyz-kd6";
    s.slice.returns = static_cast<std::uint32_t>(std::exp2(log_returns(random)));
    s.slice.extent_m = 80 + 40 * std::sin(static_cast<double>(s.slice.returns));
    s.settings.step_m = std::exp2(log_step(random));
    s.settings.level = static_cast<unsigned>(random() % 10);
    s.settings.intensity_bits = static_cast<unsigned>(random() % 9);
    size(&s);
  }
  return samples;
}

TEST(FitAdaptive, FindsTheCoefficientsThatMadeTheSamples) {
  const auto samples = Samples(400, [](Sample* s) {
    const double x = std::log2(s->settings.step_m / 0.01);
    const bool kd = s->slice.mode == "xyz-kd6";
    s->geometry_bytes = std::exp2((kd ? 11.0 : 9.0) - 0.4 * x - 0.03 * x * x +
                                  0.9 * std::log2(s->slice.returns / 1000.0));
    s->intensity_bytes =
        s->settings.intensity_bits == 0
            ? 0
            : s->slice.returns / 1000.0 * std::pow(s->settings.intensity_bits, 1.5) * 60;
  });
  const auto fit = FitAdaptive(samples);
  ASSERT_TRUE(fit);
  ASSERT_EQ(fit->modes.size(), 2U);
  const ModeCoefficients& mode = fit->modes.at("range-adaptive");
  EXPECT_NEAR(mode.step[0], 9.0, 1e-6);
  EXPECT_NEAR(mode.step[1], -0.4, 1e-6);
  EXPECT_NEAR(mode.step[2], -0.03, 1e-6);
  EXPECT_NEAR(mode.step[3], 0, 1e-6);
  EXPECT_NEAR(mode.returns, 0.9, 1e-6);
  EXPECT_NEAR(mode.intensity[1], 1.5, 1e-6);
  EXPECT_NEAR(fit->modes.at("xyz-kd6").step[0], 11.0, 1e-6);
  EXPECT_LT(ErrorOf(AdaptiveModel(*fit), samples).mean, 1e-4);
}

TEST(FitAdaptive, TakesSizesForProportionalToReturnsThatHardlyVary) {
  std::uint32_t returns = 12'000;
  const auto samples = Samples(400, [&returns](Sample* s) {
    s->slice.mode = "range-adaptive";
    s->settings.intensity_bits = 0;
    // These counts differ by less than half a doubling.
    s->slice.returns = returns = returns == 12'000 ? 15'999 : 12'000;
    s->geometry_bytes = s->slice.returns / 1000.0 * 512 * std::sqrt(0.01 / s->settings.step_m);
  });
  const auto fit = FitAdaptive(samples);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->fallback.step[0], 9, 1e-6) << "of a thousand returns";
  EXPECT_DOUBLE_EQ(fit->fallback.returns, 1);
  EXPECT_LT(ErrorOf(AdaptiveModel(*fit), samples).mean, 1e-6);
}

TEST(FitAdaptive, AModeThatIsNotKnownIsTakenForTheOneOfMostSamples) {
  auto samples = Samples(400, [](Sample* s) {
    s->settings.intensity_bits = 0;
    const double x = std::log2(s->settings.step_m / 0.01);
    s->geometry_bytes = std::exp2((s->slice.mode == "xyz-kd6" ? 11.0 : 9.0) - 0.4 * x +
                                  std::log2(s->slice.returns / 1000.0));
  });
  for (const char* rare : {"xyz-kd6", "range-adaptive"}) {
    std::size_t left = 40;
    std::vector<Sample> uneven;
    for (const Sample& s : samples) {
      if (s.slice.mode == rare && left == 0) continue;
      if (s.slice.mode == rare) --left;
      uneven.push_back(s);
    }
    const auto fit = FitAdaptive(uneven);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->fallback.step[0], rare == std::string("xyz-kd6") ? 9 : 11, 1e-6);
  }
}

TEST(FitAdaptive, MakesModelsThatCanBeReadWhateverTheSamples) {
  // The bytes of the intensity are a power of the number of its bits.
  for (const double power : {-2.0, -0.5, 0.0, 1.0, 3.0}) {
    const auto samples = Samples(400, [power](Sample* s) {
      s->geometry_bytes = s->slice.returns * std::sqrt(0.01 / s->settings.step_m);
      s->intensity_bytes = s->settings.intensity_bits == 0
                               ? 0
                               : s->slice.returns * std::pow(s->settings.intensity_bits, power);
    });
    const auto fit = FitAdaptive(samples);
    ASSERT_TRUE(fit) << power;
    ModelFile file;
    file.adaptive = *fit;
    std::string error;
    EXPECT_TRUE(ParseModelFile(WriteModelFile(file), &error)) << power << ": " << error;
  }
}

/// A model that predicts one byte for each slice.
class OneByte : public SizeModel {
 public:
  PredictedSize Predict(const SliceFeatures&, const Settings&) const override { return {1, 0}; }
  Settings Choose(const SliceFeatures&, double, const SettingLimits&) const override { return {}; }
  void OnEncoded(const SliceFeatures&, const Settings&, const EncodedSize&) override {}
};

TEST(FitErrors, AreTheMeanAndThe95thPercentileWhateverTheirOrder) {
  std::vector<Sample> samples(101);
  for (std::size_t i = 0; i < samples.size(); ++i)
    // One byte is i % too much.
    samples[i * 37 % 101].geometry_bytes = 1 / (1 + 0.01 * static_cast<double>(i));
  const FitError error = ErrorOf(OneByte(), samples);
  EXPECT_NEAR(error.mean, 0.5, 1e-9);
  EXPECT_NEAR(error.percentile_95, 0.95, 1e-9);
  EXPECT_EQ(ErrorOf(OneByte(), {}).percentile_95, 0);
}

TEST(FitAdaptive, RefusesSizesThatGrowWithTheStepAndTooFewSamples) {
  const auto growing = [](Sample* s) { s->geometry_bytes = 1000 + 1e6 * s->settings.step_m; };
  EXPECT_FALSE(FitAdaptive(Samples(400, growing)));
  EXPECT_FALSE(FitAdaptive(Samples(kMinSamples - 1, growing)));
  EXPECT_FALSE(FitAdaptive({}));
}

TEST(FitPaper, FindsThePolynomialThatMadeTheSamples) {
  const auto samples = Samples(400, [](Sample* s) {
    const double q = BitsOfStep(s->slice.extent_m, s->settings.step_m);
    const double n = s->slice.returns / 1000.0;
    s->geometry_bytes = 50000 + 30 * q * n - 20 * s->settings.level * n + 7 * q * q + n * n;
  });
  const auto fit = FitPaper(samples);
  ASSERT_TRUE(fit);
  const PaperPolynomial& p = fit->geometries.at("xyz");
  EXPECT_NEAR(p.beta, 50000, 1);
  EXPECT_NEAR(p.alpha[5], 30, 1e-3);
  EXPECT_NEAR(p.alpha[7], -20, 1e-3);
  EXPECT_LT(ErrorOf(PaperModel(*fit), samples).mean, 1e-6);
}

TEST(FitPaper, LearnsNothingFromSamplesWithoutAnExtent) {
  auto samples = Samples(400, [](Sample* s) {
    s->geometry_bytes = 5000 + 30 * BitsOfStep(s->slice.extent_m, s->settings.step_m);
  });
  const auto usual = samples;
  for (Sample odd : Samples(100, [](Sample* s) { s->geometry_bytes = 1e6; })) {
    odd.slice.extent_m = 0;
    samples.push_back(odd);
  }
  const auto fit = FitPaper(samples);
  ASSERT_TRUE(fit);
  EXPECT_LT(ErrorOf(PaperModel(*fit), usual).mean, 1e-6);
  for (Sample& sample : samples) sample.slice.extent_m = 0;
  EXPECT_FALSE(FitPaper(samples));
}

TEST(FitPaper, GivesAFeatureThatNeverVariesNoPart) {
  const auto samples = Samples(400, [](Sample* s) {
    s->settings.level = 7;
    s->geometry_bytes = 5000 + 3 * BitsOfStep(s->slice.extent_m, s->settings.step_m);
  });
  const auto fit = FitPaper(samples);
  ASSERT_TRUE(fit);
  EXPECT_LT(ErrorOf(PaperModel(*fit), samples).mean, 1e-6);
  for (const double alpha : fit->geometries.at("xyz").alpha) EXPECT_LT(std::abs(alpha), 1e4);
}

TEST(AdaptiveModel, TakesTheStepOfTheGridWhoseSizeIsNearestButNotFarAbove) {
  AdaptiveCoefficients c;
  c.fallback.step = {10, -0.5, 0, 0};  // bytes = 1024 sqrt(10 mm / step)
  AdaptiveModel model(c);
  SliceFeatures slice;
  slice.returns = 1000;
  SettingLimits limits;
  limits.finest_step_m = 0.001;
  limits.step_unit_m = 0.002;
  limits.coarsest_step_m = 0.041;
  // At steps of 1, 3 and 5 mm, the slice has 3238, 1870 and 1448 bytes.
  EXPECT_NEAR(model.Choose(slice, 1900, limits).step_m, 0.003, 1e-12);
  EXPECT_NEAR(model.Choose(slice, 1800, limits).step_m, 0.003, 1e-12);
  EXPECT_NEAR(model.Choose(slice, 2700, limits).step_m, 0.003, 1e-12) << "1 mm is 20 % over";
  EXPECT_NEAR(model.Choose(slice, 3200, limits).step_m, 0.001, 1e-12);
  EXPECT_NEAR(model.Choose(slice, 1, limits).step_m, 0.041, 1e-12);
  EXPECT_NEAR(model.Choose(slice, 1e9, limits).step_m, 0.001, 1e-12);
}

TEST(PaperModel, ChoosesTheGridPointNearestToTheTarget) {
  PaperPolynomial p;
  p.alpha[0] = 1000;  // bytes = 1000 q - 100 c
  p.alpha[1] = -100;
  PaperModel model({{{"xyz", p}}});
  SliceFeatures slice;
  slice.mode = "xyz-kd6";
  slice.extent_m = 100;
  slice.returns = 1000;
  SettingLimits limits;
  limits.finest_step_m = 1e-9;
  limits.coarsest_step_m = 1;
  const Settings s = model.Choose(slice, 13700, limits);
  EXPECT_NEAR(BitsOfStep(100, s.step_m), 14, 1e-9);
  EXPECT_EQ(s.level, 3U);
  EXPECT_EQ(model.Choose(slice, 13100, limits).level, 9U) << "the highest level";
  // A step coarser than the error bound is not chosen, however small the target is.
  limits.coarsest_step_m = StepOfBits(100, 12);
  EXPECT_NEAR(BitsOfStep(100, model.Choose(slice, 1, limits).step_m), 12, 1e-9);
}

TEST(PaperModel, PredictsAGeometryThatItLacksAsOneThatItHas) {
  PaperPolynomial p;
  p.alpha[0] = 1000;  // bytes = 1000 q
  const PaperModel model({{{"xyz", p}}});
  SliceFeatures slice;
  slice.extent_m = 100;
  slice.returns = 1000;
  Settings settings;
  settings.step_m = StepOfBits(100, 7);
  for (const char* mode : {"xyz-kd6", "range-adaptive"}) {
    slice.mode = mode;
    EXPECT_NEAR(model.Predict(slice, settings).total(), 7000, 1e-6) << mode;
  }
  EXPECT_EQ(PaperModel(PaperCoefficients{}).Predict(slice, settings).total(), 0) << "it has none";
}

}  // namespace
}  // namespace lidar::rate
