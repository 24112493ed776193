// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/adaptive_model.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace lidar::rate {
namespace {

constexpr std::uint32_t kSlices = 4;
const Settings kTwoCentimetres{0.02, 0, 0};

SliceFeatures Slice(std::uint32_t scan, std::uint32_t index) {
  SliceFeatures slice;
  slice.scan_id = scan;
  slice.slice_index = index;
  slice.slice_count = kSlices;
  slice.returns = 5000;
  slice.extent_m = 80;
  slice.mode = "none that has coefficients";
  return slice;
}

double Bytes(const AdaptiveModel& model, const SliceFeatures& slice) {
  return model.Predict(slice, kTwoCentimetres).total();
}

/// Returns a model that has learned one scan. Each slice of the scan had the size that the model
/// predicted.
AdaptiveModel Taught() {
  AdaptiveModel model(AdaptiveCoefficients{{}, {{11, -0.5, 0, 0}}});
  for (std::uint32_t i = 0; i < kSlices; ++i) {
    const auto bytes = static_cast<std::int64_t>(Bytes(model, Slice(1, i)));
    model.OnEncoded(Slice(1, i), kTwoCentimetres, {DataSize::Bytes(bytes), 0.02, 1});
  }
  return model;
}

TEST(AdaptiveModel, LearnsNothingFromASliceThatIsLargerThanItsReturnsUncoded) {
  AdaptiveModel model = Taught();
  const SliceFeatures slice = Slice(2, 0);
  const double before = Bytes(model, slice);
  const auto encoded = [&](std::int64_t bytes_a_return) {
    return EncodedSize{DataSize::Bytes(bytes_a_return * slice.returns), 0.02, 1};
  };
  model.OnEncoded(slice, kTwoCentimetres, encoded(65));
  EXPECT_DOUBLE_EQ(Bytes(model, slice), before);
  model.OnEncoded(slice, kTwoCentimetres, encoded(63));
  EXPECT_GT(Bytes(model, slice), 2 * before);
}

TEST(AdaptiveModel, LearnsNothingFromWhatIsNoMeasure) {
  const SliceFeatures slice = Slice(2, 0);
  SliceFeatures few = slice;
  few.returns = 63;  // With so few returns, most bytes of the slice are headers.
  const EncodedSize good{DataSize::Bytes(30'000), 0.02, 1};
  const std::vector<std::pair<SliceFeatures, EncodedSize>> none = {
      {few, {DataSize::Bytes(1'000), 0.02, 1}},
      {slice, {DataSize::Bytes(1), 0.02, 1}},
      {slice, {DataSize::Bytes(30'000), 0, 1}},
      {slice, {DataSize::Bytes(30'000), -0.02, 1}},
      {slice, {DataSize::Bytes(30'000), std::nan(""), 1}}};
  for (const auto& [features, encoded] : none) {
    AdaptiveModel model = Taught();
    const double before = Bytes(model, slice);
    model.OnEncoded(features, kTwoCentimetres, encoded);
    EXPECT_DOUBLE_EQ(Bytes(model, slice), before);
    model.OnEncoded(slice, kTwoCentimetres, good);
    EXPECT_GT(Bytes(model, slice), 2 * before);
  }
}

TEST(AdaptiveModel, GoesOnStraightBeyondTheStepsOfItsTraining) {
  ModeCoefficients fit{{11, -0.5, -0.02, 0}};
  fit.min_x = -2;
  fit.max_x = 4;
  // The slope of the fit is -0.5 - 0.04 x, which is -0.42 at `min_x` and -0.66 at `max_x`.
  EXPECT_NEAR(fit.GeometryLog2(-5, 0) - fit.GeometryLog2(-2, 0), 3 * 0.42, 1e-9);
  EXPECT_NEAR(fit.GeometryLog2(7, 0) - fit.GeometryLog2(4, 0), -3 * 0.66, 1e-9);
}

TEST(AdaptiveModel, PassesASurpriseOnToTheNextSlice) {
  AdaptiveModel model = Taught();
  const double before = Bytes(model, Slice(2, 1));
  const EncodedSize larger{DataSize::Bytes(static_cast<std::int64_t>(1.5 * before)), 0.02, 1};
  model.OnEncoded(Slice(2, 0), kTwoCentimetres, larger);
  EXPECT_GT(Bytes(model, Slice(2, 1)), 1.05 * before);
}

TEST(AdaptiveModel, LearnsFromASliceThatIsEncodedAgainAsIfItWereEncodedOnce) {
  AdaptiveModel once = Taught();
  AdaptiveModel again = Taught();
  const EncodedSize larger{
      DataSize::Bytes(static_cast<std::int64_t>(1.5 * Bytes(once, Slice(2, 0)))), 0.02, 1};
  once.OnEncoded(Slice(2, 0), kTwoCentimetres, larger);
  for (int i = 0; i < 2; ++i) again.OnEncoded(Slice(2, 0), kTwoCentimetres, larger);
  EXPECT_NEAR(Bytes(again, Slice(2, 1)) / Bytes(once, Slice(2, 1)), 1, 1e-6);
}

TEST(AdaptiveModel, KeepsWhatItKnowsOfTheSceneWhereTheModeChangesWithinAGeometry) {
  AdaptiveModel model(AdaptiveCoefficients{{}, {{11, -0.5, 0, 0}}});
  SliceFeatures slice = Slice(1, 0);
  slice.mode = "range-adaptive";
  const double fit = Bytes(model, slice);
  const EncodedSize larger{DataSize::Bytes(static_cast<std::int64_t>(2 * fit)), 0.02, 1};
  model.OnEncoded(slice, kTwoCentimetres, larger);
  slice.scan_id = 2;
  slice.mode = "range-mixing2";
  EXPECT_NEAR(Bytes(model, slice) / fit, 2, 0.1);
  model.OnEncoded(slice, kTwoCentimetres, larger);
  EXPECT_NEAR(Bytes(model, slice) / fit, 2, 0.1);
  slice.mode = "xyz-kd6";
  EXPECT_NEAR(Bytes(model, slice) / fit, 1, 1e-6);
}

TEST(AdaptiveModel, KnowsFromThinnedScansWhatTheIntensityOfAWholeOneTakes) {
  ModeCoefficients fit{{11, -0.5, 0, 0}};
  fit.intensity = {9, 1};
  AdaptiveModel model(AdaptiveCoefficients{{}, fit});
  const Settings settings{0.02, 4, 0};
  const PredictedSize whole = model.Predict(Slice(0, 0), settings);
  constexpr double kKept = 1.0 / 16;
  for (std::uint32_t scan = 0; scan < 30; ++scan) {
    for (std::uint32_t i = 0; i < kSlices; ++i) {
      EncodedSize encoded{DataSize::Bytes(static_cast<std::int64_t>(kKept * whole.total())), 0.02,
                          1};
      encoded.keep_fraction = kKept;
      model.OnEncoded(Slice(scan, i), settings, encoded);
    }
  }
  const PredictedSize learned = model.Predict(Slice(30, 0), settings);
  EXPECT_GT(learned.intensity_bytes, whole.intensity_bytes / 2);
  EXPECT_LT(learned.intensity_bytes, whole.intensity_bytes * 2);
}

TEST(AdaptiveModel, TakesNoPartOfASliceForNothingAfterManyMovesOfTheStep) {
  constexpr unsigned kBits = 4;
  ModeCoefficients fit{{11, -0.5, 0, 0}};
  fit.intensity = {9, 1};
  AdaptiveModel model(AdaptiveCoefficients{{}, fit});
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.1);
  std::array<double, kSlices> scene{};  // the binary logarithm of the size of each slice
  for (std::uint32_t scan = 0; scan < 2000; ++scan) {
    for (std::uint32_t i = 0; i < kSlices; ++i) {
      const SliceFeatures slice = Slice(scan, i);
      scene[i] = 0.98 * scene[i] + noise(random);
      // Each slice is encoded with the step of its scan, and then again with a step of 2 cm.
      for (const double step_m : {scan % 20 < 10 ? 0.001 : 0.1, 0.02}) {
        const Settings settings{step_m, kBits, 0};
        const double bytes = (10 / step_m + 1e3) * std::exp2(scene[i]);
        model.OnEncoded(slice, settings,
                        {DataSize::Bytes(static_cast<std::int64_t>(bytes)), step_m, 1});
        const PredictedSize size = model.Predict(slice, settings);
        ASSERT_GT(size.geometry_bytes, 1e-3 * size.total()) << "scan " << scan;
        ASSERT_GT(size.intensity_bytes, 1e-3 * size.total()) << "scan " << scan;
      }
    }
  }
}

}  // namespace
}  // namespace lidar::rate
