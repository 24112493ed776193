// SPDX-License-Identifier: LGPL-2.1-or-later
#include "rate/residual_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

namespace lidar::rate {
namespace {

class ErrorBound : public ::testing::TestWithParam<double> {};

TEST_P(ErrorBound, OfXyzIsReachedAtACornerOfTheGridAndNeverPassed) {
  const double error = GetParam();
  const double step = ResidualModel::Xyz().CoarsestStep(error);
  EXPECT_NEAR(ResidualModel::Xyz().MaxError(step), error, 1e-12);
  const double half = step / 2;
  EXPECT_NEAR(std::sqrt(3 * half * half), error, 1e-12);
}

TEST_P(ErrorBound, OfRangesHoldsForEveryRangeAndIsTheCoarsestThatDoes) {
  for (const unsigned unit_mm : {1U, 3U, 4U, 8U}) {
    const double unit = 1e-3 * unit_mm;
    const ResidualModel model = ResidualModel::Range(unit_mm);
    const auto n = static_cast<std::int64_t>(std::llround(model.CoarsestStep(GetParam()) / unit));
    ASSERT_GE(n, 1);
    double worst = 0;
    for (std::int64_t r = 0; r < 1000; ++r) {
      const double middle = static_cast<double>(r / n * n) + static_cast<double>(n - 1) / 2;
      worst = std::max(worst, std::abs(static_cast<double>(r) - middle) * unit);
    }
    EXPECT_LE(worst, GetParam() + 1e-12);
    EXPECT_NEAR(worst, model.MaxError(static_cast<double>(n) * unit), 1e-12);
    EXPECT_EQ((n - 1) * unit_mm % 2, 0) << "the middle is a whole number of millimetres";
    EXPECT_GT(model.MaxError(static_cast<double>(n) * unit + model.step_unit()), GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(All, ErrorBound, ::testing::Values(0.001, 0.01, 0.02, 0.05, 0.3));

TEST(ResidualModel, AnErrorBelowTheResolutionGivesTheSensorsOwnUnit) {
  EXPECT_DOUBLE_EQ(ResidualModel::Range(8).CoarsestStep(0.003), 0.008);
  EXPECT_DOUBLE_EQ(ResidualModel::Range(8).MaxError(0.008), 0);
  EXPECT_DOUBLE_EQ(ResidualModel::Range(1).CoarsestStep(-1), 0.001);
}

TEST(ResidualModel, MeanErrorIsThatOfPointsSpreadEvenly) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-0.5, 0.5);
  double sum = 0;
  constexpr int kPoints = 400000;
  for (int i = 0; i < kPoints; ++i) {
    const double x = at(random), y = at(random), z = at(random);
    sum += std::sqrt(x * x + y * y + z * z);
  }
  EXPECT_NEAR(ResidualModel::Xyz().MeanError(1), sum / kPoints, 1e-3);
  // Bins of five units are off by 2, 1, 0, 1, 2; two of 2 mm by 1 mm.
  EXPECT_NEAR(ResidualModel::Range(1).MeanError(0.005), 0.0012, 1e-12);
  EXPECT_NEAR(ResidualModel::Range(2).MeanError(0.004), 0.001, 1e-12);
}

}  // namespace
}  // namespace lidar::rate
