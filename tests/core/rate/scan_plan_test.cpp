// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/scan_plan.h"

#include <gtest/gtest.h>

namespace lidar::rate {
namespace {

/// Returns the inputs of a scan whose geometry needs 60 bytes. Each bit of intensity needs four
/// more bytes, so the scan needs 92 bytes with all eight bits.
ScanPlanInputs Inputs(double budget, unsigned last_intensity_bits) {
  ScanPlanInputs in;
  in.needed.coarsest = in.needed.finest = 60;
  for (unsigned bits = 0; bits < in.needed.intensity.size(); ++bits)
    in.needed.intensity[bits] = 4 * bits;
  in.budget = budget;
  in.measured = true;
  in.intensity_bits = 8;
  in.last_intensity_bits = last_intensity_bits;
  return in;
}

unsigned IntensityBits(double budget, unsigned last) {
  return PlanScan(Inputs(budget, last), DegradationPreference::kMaintainAccuracy).intensity_bits;
}

TEST(ScanPlan, KeepsTheIntensityThatFits) {
  EXPECT_EQ(IntensityBits(92, 8), 8U);
  EXPECT_EQ(IntensityBits(91, 8), 7U);
  EXPECT_EQ(IntensityBits(50, 8), 0U);
}

TEST(ScanPlan, RaisesTheIntensityOnlyWithATenthToSpare) {
  EXPECT_EQ(IntensityBits(92 / 0.95, 7), 7U);
  EXPECT_EQ(IntensityBits(92 / 0.91, 7), 7U);
  EXPECT_EQ(IntensityBits(92 / 0.89, 7), 8U);
}

TEST(ScanPlan, SkipsOnlyWhenMoreThanATenthOfAScanIsOwed) {
  ScanPlanInputs in = Inputs(50, 0);  // The scan needs 60 bytes.
  in.saved = 5;
  EXPECT_FALSE(PlanScan(in, DegradationPreference::kMaintainAccuracy).skip);
  in.saved = 3;
  EXPECT_TRUE(PlanScan(in, DegradationPreference::kMaintainAccuracy).skip);
}

TEST(ScanPlan, ThinsToASixteenthAtMostAndSkipsBelow) {
  ScanPlanInputs in = Inputs(60.0 / 8, 0);
  ScanPlan plan = PlanScan(in, DegradationPreference::kMaintainFramerate);
  EXPECT_DOUBLE_EQ(plan.keep_fraction, 1.0 / 8);
  EXPECT_FALSE(plan.skip);
  in.budget = 60.0 / 4;
  in.saved = -60.0 / 16;
  plan = PlanScan(in, DegradationPreference::kMaintainFramerate);
  EXPECT_DOUBLE_EQ(plan.keep_fraction, 3.0 / 16) << "a debt thins a scan further";
  EXPECT_FALSE(plan.skip);
  in.saved = 0;
  in.budget = 60.0 / 50;
  plan = PlanScan(in, DegradationPreference::kMaintainFramerate);
  EXPECT_DOUBLE_EQ(plan.keep_fraction, 1.0 / 16);
  EXPECT_TRUE(plan.skip);
}

TEST(ThinningPattern, KeepsTheShareEvenlyAndNeverNothing) {
  EXPECT_EQ(ThinningPattern(6, 0.5), (std::vector<bool>{false, true, false, true, false, true}));
  EXPECT_EQ(ThinningPattern(3, 0.01), (std::vector<bool>{false, true, false}));
  EXPECT_EQ(ThinningPattern(0, 1), std::vector<bool>{});
}

}  // namespace
}  // namespace lidar::rate
