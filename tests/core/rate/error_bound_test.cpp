// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/error_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

namespace lidar::rate {
namespace {

class ErrorBounds : public ::testing::TestWithParam<double> {};

TEST_P(ErrorBounds, OfXyzIsReachedAtACornerOfTheGridAndNeverPassed) {
  const double error = GetParam();
  const double step = ErrorBound::Xyz().CoarsestStep(error);
  EXPECT_NEAR(ErrorBound::Xyz().MaxError(step), error, 1e-12);
  const double half = step / 2;
  EXPECT_NEAR(std::sqrt(3 * half * half), error, 1e-12);
}

struct RangeErrors {
  double largest = 0;
  double mean = 0;
};

/// Returns the errors of the ranges from 0 to `units` - 1 units on a grid whose bins have `parts` /
/// 256 units. A bin decodes to the middle between its first and its last range, rounded up to a
/// millimetre.
RangeErrors ErrorsOfRanges(std::int64_t parts, unsigned unit_mm, std::int64_t units) {
  RangeErrors errors;
  for (std::int64_t first = 0; first < units;) {
    std::int64_t end = first;
    while (end * 256 / parts == first * 256 / parts) ++end;
    const auto middle = std::ceil(static_cast<double>((first + end - 1) * unit_mm) / 2);
    for (; first < end; ++first) {
      const double error = 1e-3 * std::abs(static_cast<double>(first * unit_mm) - middle);
      errors.largest = std::max(errors.largest, error);
      errors.mean += error / static_cast<double>(units);
    }
  }
  return errors;
}

TEST_P(ErrorBounds, OfRangesHoldsForEveryRangeAndIsTheCoarsestThatDoes) {
  for (const unsigned unit_mm : {1U, 3U, 4U, 8U}) {
    const ErrorBound model = ErrorBound::Range(unit_mm);
    const double step = model.CoarsestStep(GetParam());
    const auto parts = static_cast<std::int64_t>(std::llround(step / model.step_unit()));
    ASSERT_GE(parts, 256);
    const double worst = ErrorsOfRanges(parts, unit_mm, 20'000).largest;
    EXPECT_LE(worst, GetParam() + 1e-12);
    EXPECT_NEAR(worst, model.MaxError(step), 1e-12);
    EXPECT_GT(model.MaxError(step + model.step_unit()), GetParam());
    EXPECT_GT(ErrorsOfRanges(parts + 1, unit_mm, 200'000).largest, GetParam());
  }
}

TEST(ErrorBound, KnowsTheErrorsOfStepsBetweenWholeUnits) {
  for (const unsigned unit_mm : {1U, 2U, 3U, 8U}) {
    const ErrorBound model = ErrorBound::Range(unit_mm);
    for (const std::int64_t parts : {256, 300, 384, 511, 640, 1000, 1281, 5000}) {
      const RangeErrors errors = ErrorsOfRanges(parts, unit_mm, 400'000);
      const double step = static_cast<double>(parts) * model.step_unit();
      EXPECT_NEAR(model.MaxError(step), errors.largest, 1e-12) << unit_mm << " mm, " << parts;
      EXPECT_NEAR(model.MeanError(step), errors.mean, 0.01e-3) << unit_mm << " mm, " << parts;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ErrorBounds, ::testing::Values(0.001, 0.01, 0.02, 0.05, 0.3));

TEST(ErrorBound, AnErrorBelowTheResolutionGivesTheSensorsOwnUnit) {
  EXPECT_DOUBLE_EQ(ErrorBound::Range(8).CoarsestStep(0.003), 0.008);
  EXPECT_DOUBLE_EQ(ErrorBound::Range(8).MaxError(0.008), 0);
  EXPECT_DOUBLE_EQ(ErrorBound::Range(1).CoarsestStep(-1), 0.001);
}

TEST(ErrorBound, TheFinestStepIsTheSensorsUnitOrAMillimetreAndSmallErrorsReachIt) {
  EXPECT_DOUBLE_EQ(ErrorBound::Xyz().FinestStep(), 0.001);
  EXPECT_DOUBLE_EQ(ErrorBound::Xyz().step_unit(), 0);
  for (const unsigned unit_mm : {1U, 2U, 8U}) {
    const ErrorBound range = ErrorBound::Range(unit_mm);
    EXPECT_DOUBLE_EQ(range.FinestStep(), 0.001 * unit_mm);
    EXPECT_DOUBLE_EQ(range.CoarsestStep(0), range.FinestStep());
  }
}

TEST(ErrorBound, MeanErrorIsThatOfPointsSpreadEvenly) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-0.5, 0.5);
  double sum = 0;
  constexpr int kPoints = 400000;
  for (int i = 0; i < kPoints; ++i) {
    const double x = at(random), y = at(random), z = at(random);
    sum += std::sqrt(x * x + y * y + z * z);
  }
  EXPECT_NEAR(ErrorBound::Xyz().MeanError(1), sum / kPoints, 1e-3);
  // Five units of 1 mm in a bin have errors of 2, 1, 0, 1 and 2 mm. Two units of 2 mm in a bin have
  // errors of 1 mm each.
  EXPECT_NEAR(ErrorBound::Range(1).MeanError(0.005), 0.0012, 1e-12);
  EXPECT_NEAR(ErrorBound::Range(2).MeanError(0.004), 0.001, 1e-12);
}

}  // namespace
}  // namespace lidar::rate
