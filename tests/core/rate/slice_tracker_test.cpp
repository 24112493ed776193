// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/slice_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lidar::rate {
namespace {

constexpr double kGain = 0.3;    // the share of an innovation that is added to the drift
constexpr double kWeight = 0.7;  // the share of the drift that is added to a prediction

/// Returns a tracker that has observed one scan. Each sector of the scan had the predicted size.
SliceTracker AfterOneScan(std::uint32_t slices) {
  SliceTracker tracker;
  for (std::uint32_t i = 0; i < slices; ++i) tracker.Observe(i, slices, {1, 0}, 0);
  return tracker;
}

TEST(SliceTracker, KnowsNothingBeforeTheFirstSlice) { EXPECT_FALSE(SliceTracker().Predict(0, 4)); }

TEST(SliceTracker, StartsFromTheSameSectorOfTheScanBefore) {
  SliceTracker tracker;
  for (std::uint32_t i = 0; i < 4; ++i) tracker.Observe(i, 4, {1, 0.5 * i}, 0);
  EXPECT_DOUBLE_EQ(tracker.Predict(2, 4)->residual, 1);
  EXPECT_DOUBLE_EQ(tracker.Predict(2, 8)->residual, 1.5) << "no such sector: the last slice";
}

TEST(SliceTracker, PassesWhatOneSectorTaughtOnToTheNext) {
  SliceTracker tracker = AfterOneScan(4);
  tracker.Observe(0, 4, {1, 0.4}, 0.4);
  EXPECT_DOUBLE_EQ(tracker.Predict(1, 4)->residual, kWeight * kGain * 0.4);
}

TEST(SliceTracker, FollowsADriftThatAllSectorsShareWithoutBias) {
  constexpr double kTrue = 0.4;
  SliceTracker tracker = AfterOneScan(8);
  for (std::uint32_t i = 0; i < 8; ++i)
    tracker.Observe(i, 8, {1, kTrue}, kTrue - tracker.Predict(i, 8)->residual);
  // The predictions contain a part of the drift, which makes their errors smaller. The tracker adds
  // this part to the errors again, so that the drift approaches the whole change.
  const double drift = kTrue * (1 - std::pow(1 - kGain, 8));
  EXPECT_NEAR(tracker.Predict(0, 8)->residual, kTrue + kWeight * drift, 1e-9);
}

TEST(SliceTracker, TakesTheNoiseOfAScanOfOneSliceForNoDrift) {
  SliceTracker tracker = AfterOneScan(1);
  tracker.Observe(0, 1, {1, 0.4}, 0.4);
  EXPECT_DOUBLE_EQ(tracker.Predict(0, 1)->residual, 0.4);
}

TEST(SliceTracker, ForgetsTheDriftOfAnotherNumberOfSlices) {
  SliceTracker tracker = AfterOneScan(4);
  tracker.Observe(0, 4, {1, 0.4}, 0.4);
  tracker.Observe(0, 8, {1, 0.2}, 0);
  EXPECT_DOUBLE_EQ(tracker.Predict(0, 8)->residual, 0.2);
}

TEST(SliceTracker, LearnsNoDriftFromASliceThatIsPutInPlaceOfAnother) {
  SliceTracker tracker = AfterOneScan(4);
  tracker.Observe(0, 4, {1, 0.4}, 0.4);
  tracker.Replace(0, 4, {2, 0.9});
  EXPECT_DOUBLE_EQ(tracker.Predict(0, 4)->residual, 0.9 + kWeight * kGain * 0.4);
  EXPECT_DOUBLE_EQ(tracker.Predict(1, 4)->residual, kWeight * kGain * 0.4);
}

}  // namespace
}  // namespace lidar::rate
