// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the promises of docs/rate-control.md under "Bad input".
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "src/rate/model_file.h"
#include "src/rate/rate_controller.h"
#include "src/sim/synthetic_codec.h"

namespace lidar::rate {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class BadInput : public ::testing::Test {
 protected:
  explicit BadInput(RateModel model = RateModel::kAdaptive)
      : controller_(Parameters(), MakeBuiltInModel(model)) {}

  static ControllerParameters Parameters() {
    ControllerParameters p;
    p.limits.finest_step_m = 0.001;
    p.limits.coarsest_step_m = 0.04;
    return p;
  }
  /// Encodes one slice, and expects the decision to be within the limits. Returns the decision.
  Decision Play(const SliceFeatures& f) {
    const Decision d = controller_.NextSlice(f);
    EXPECT_GE(d.settings.step_m, 0.001);
    EXPECT_LE(d.settings.step_m, 0.04);
    EXPECT_GT(d.keep_fraction, 0);
    EXPECT_LE(d.keep_fraction, 1);
    if (d.skip) return d;
    const auto again = controller_.OnEncoded(codec_.Encode(f, d.settings));
    EXPECT_FALSE(again && controller_.OnEncoded(codec_.Encode(f, *again)));
    return d;
  }

  SyntheticCodec codec_{{}};
  RateController controller_;
};

class BadInputOfAnyModel : public BadInput, public ::testing::WithParamInterface<RateModel> {
 protected:
  BadInputOfAnyModel() : BadInput(GetParam()) {}
};

TEST_P(BadInputOfAnyModel, InFeaturesGivesADecisionWithinTheLimits) {
  controller_.SetTarget(DataRate::BitsPerSecond(3e6));
  const std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t scan = 0;
  for (const double rate : {0.0, -5.0, kNan, kInfinity, 1e9, 1e-300})
    for (const double extent : {0.0, -1.0, kNan, kInfinity, 1e4})
      for (const std::uint32_t count : {0U, 1U, 8U, most})
        for (const std::uint32_t returns : {0U, 1U, 100000U, most}) {
          SliceFeatures f;
          f.scan_id = ++scan;
          f.slice_index = count / 2 + 7;
          f.slice_count = count;
          f.scans_per_second = rate;
          f.returns = returns;
          f.extent_m = extent;
          f.mode = "";
          Play(f);
        }
  EXPECT_TRUE(std::isfinite(controller_.bounds().min.bits_per_second()));
  EXPECT_TRUE(std::isfinite(controller_.stats().saved_bytes));
}

TEST_F(BadInput, OfOneBitASecondSendsTheFirstScanAndThenNoMore) {
  controller_.SetTarget(DataRate::BitsPerSecond(1));
  for (std::uint32_t scan = 0; scan < 50; ++scan)
    for (std::uint32_t i = 0; i < 8; ++i)
      EXPECT_EQ(Play(codec_.Features(scan, i)).skip, scan > 0) << scan;
  EXPECT_EQ(controller_.stats().scans_skipped, 49U);
}

TEST_F(BadInput, OfFourGigabitsTakesTheFinestUsefulStep) {
  controller_.SetTarget(DataRate::BitsPerSecond(4e9));
  for (std::uint32_t scan = 0; scan < 5; ++scan)
    for (std::uint32_t i = 0; i < 8; ++i)
      EXPECT_NEAR(Play(codec_.Features(scan, i)).settings.step_m, 0.001, 1e-9);
}

TEST_F(BadInput, OfTargetsThatAreNoRatesCountsAsZeroOrAsATerabit) {
  for (const double bps : {kNan, -1.0, 0.0, -kInfinity}) {
    RateController controller(Parameters(), MakeBuiltInModel(RateModel::kAdaptive));
    controller.SetTarget(DataRate::BitsPerSecond(bps));
    for (std::uint32_t scan = 0; scan < 3; ++scan) {
      const SliceFeatures f = codec_.Features(scan, 0);
      const Decision d = controller.NextSlice(f);
      EXPECT_EQ(d.skip, scan > 0) << bps;
      if (!d.skip) controller.OnEncoded(codec_.Encode(f, d.settings));
    }
  }
  controller_.SetTarget(DataRate::Infinite());
  EXPECT_NEAR(Play(codec_.Features(0, 0)).settings.step_m, 0.001, 1e-9);
}

TEST_P(BadInputOfAnyModel, OutOfTurnIsIgnored) {
  EXPECT_FALSE(controller_.OnEncoded({DataSize::Bytes(100), 0.01, 1}));
  EXPECT_EQ(controller_.bounds().min.bits_per_second(), 0);
  controller_.SetTarget(DataRate::BitsPerSecond(3e6));
  for (std::uint32_t i = 0; i < 100; ++i) controller_.NextSlice(codec_.Features(i, 3));
  Play(codec_.Features(100, 0));
}

TEST_F(BadInput, OfAbsurdSizesDoesNotPoisonTheModel) {
  controller_.SetTarget(DataRate::BitsPerSecond(3e6));
  const std::int64_t huge = std::int64_t{1} << 50;
  for (const std::int64_t bytes : {std::int64_t{-5}, std::int64_t{0}, std::int64_t{1}, huge}) {
    for (const double step : {0.0, -1.0, kNan, 0.01}) {
      const SliceFeatures f = codec_.Features(static_cast<std::uint32_t>(bytes % 1000) + 5, 0);
      controller_.NextSlice(f);
      EncodedSize encoded{DataSize::Bytes(bytes), step, 1};
      controller_.OnEncoded(encoded);
      controller_.OnEncoded(encoded);
    }
  }
  // After some scans with good input, the controller works as before.
  double last = 0;
  for (std::uint32_t scan = 2000; scan < 2400; ++scan) {
    last = 0;
    for (std::uint32_t i = 0; i < 8; ++i) {
      const SliceFeatures f = codec_.Features(scan, i);
      Decision d = controller_.NextSlice(f);
      if (d.skip) continue;
      EncodedSize encoded = codec_.Encode(f, d.settings);
      if (const auto again = controller_.OnEncoded(encoded)) {
        encoded = codec_.Encode(f, *again);
        controller_.OnEncoded(encoded);
      }
      last += encoded.size.bits() * 10;
    }
  }
  EXPECT_NEAR(last / 3e6, 1, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Models, BadInputOfAnyModel,
                         ::testing::Values(RateModel::kAdaptive, RateModel::kPaper));

}  // namespace
}  // namespace lidar::rate
