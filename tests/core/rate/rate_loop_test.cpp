// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/rate_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/rate/model_file.h"

namespace lidar::rate {
namespace {

/// A coder whose slices take one byte per return at a step of 1 cm, and less at a coarser step.
class FakeCoder : public SliceCoder {
 public:
  LoadedSlice loaded() const override { return {1'000, 50, rows, true, 3, "fake"}; }
  StepRange Steps(double max_error_m) const override { return {0.001, 2 * max_error_m, 0}; }
  void Thin(const std::vector<bool>& pattern) override {
    kept = static_cast<std::size_t>(std::count(pattern.begin(), pattern.end(), true));
  }
  CodingResult Encode(double max_error_m, const Settings& settings, CodedSlice* slice) override {
    asked.push_back(settings);
    errors.push_back(max_error_m);
    const double returns = 1'000.0 * static_cast<double>(kept) / static_cast<double>(rows);
    *slice = {
        static_cast<std::size_t>(bytes_a_return * returns * std::sqrt(0.01 / settings.step_m)),
        static_cast<std::size_t>(returns), settings.step_m, settings.step_m / 2};
    return result;
  }

  std::size_t rows = 32;
  std::size_t kept = 32;
  double bytes_a_return = 1;
  CodingResult result = CodingResult::kEncoded;
  std::vector<Settings> asked;
  std::vector<double> errors;
};

class RateLoopTest : public ::testing::Test {
 protected:
  LoopResult Encode(std::uint32_t scan, std::optional<DataRate> target = std::nullopt) {
    return loop_.Encode({scan, 0, 1, 10}, settings_, target, &coder_);
  }
  FakeCoder coder_;
  LoopSettings settings_;
  RateLoop loop_{MakeBuiltInModel(RateModel::kAdaptive)};
};

TEST_F(RateLoopTest, WithoutATargetTakesTheCoarsestStepThatTheErrorAllows) {
  const LoopResult result = Encode(0);
  ASSERT_TRUE(result.encoded());
  EXPECT_DOUBLE_EQ(result.slice.step_m, 0.04);
  EXPECT_EQ(coder_.asked.size(), 1U);
  EXPECT_DOUBLE_EQ(coder_.errors[0], 0.02);
  EXPECT_EQ(result.intensity_bits, 5U);
}

TEST_F(RateLoopTest, KeepsToAFixedStepWhateverTheTarget) {
  settings_.fixed_step_m = 0.013;
  for (std::uint32_t scan = 0; scan < 5; ++scan) {
    const LoopResult result = Encode(scan, DataRate::BitsPerSecond(1));
    ASSERT_TRUE(result.encoded());
    EXPECT_DOUBLE_EQ(result.slice.step_m, 0.013);
  }
}

TEST_F(RateLoopTest, CanUseNoMoreThanAFixedStepNeeds) {
  settings_.fixed_step_m = 0.013;
  Encode(0, DataRate::BitsPerSecond(1));
  const RateBounds fixed = loop_.controller().bounds();
  EXPECT_EQ(fixed.max, fixed.nominal);
  EXPECT_GT(fixed.nominal, DataRate());
  settings_.fixed_step_m = 0;
  Encode(1);
  const RateBounds free = loop_.controller().bounds();
  EXPECT_GT(free.max, fixed.max) << "finer steps";
  EXPECT_LT(free.nominal, fixed.nominal) << "coarser steps";
}

TEST_F(RateLoopTest, AFixedStepEndsWithTheSetting) {
  settings_.fixed_step_m = 0.001;
  Encode(0);
  settings_.fixed_step_m = 0;
  EXPECT_DOUBLE_EQ(Encode(1).slice.step_m, 0.04);
}

TEST_F(RateLoopTest, NeverAsksForAFixedStepPastTheError) {
  settings_.fixed_step_m = 3;
  EXPECT_DOUBLE_EQ(Encode(0).slice.step_m, 0.04);
}

TEST_F(RateLoopTest, EncodesTwiceWhereTheFirstSizeMissesTheBudgetByMuch) {
  for (std::uint32_t scan = 0; scan < 10; ++scan) Encode(scan, DataRate::BitsPerSecond(80'000));
  coder_.asked.clear();
  Encode(10, DataRate::BitsPerSecond(80'000));
  EXPECT_EQ(coder_.asked.size(), 1U);  // The model has learned the sizes of this coder.
  coder_.asked.clear();
  coder_.bytes_a_return = 3;
  Encode(11, DataRate::BitsPerSecond(80'000));
  EXPECT_EQ(coder_.asked.size(), 2U);
  EXPECT_GT(coder_.asked[1].step_m, coder_.asked[0].step_m);
}

TEST_F(RateLoopTest, SkipsScansOrThinsRowsBelowTheMinimum) {
  const auto half = DataRate::BitsPerSecond(0.5 * 80 * 1'000 * 0.5);
  unsigned skipped = 0;
  for (std::uint32_t scan = 0; scan < 40; ++scan) skipped += Encode(scan, half).skipped ? 1U : 0U;
  EXPECT_NEAR(skipped, 20, 3);
  settings_.degradation = DegradationPreference::kMaintainFramerate;
  const LoopResult result = Encode(50, half);
  EXPECT_FALSE(result.skipped);
  EXPECT_LT(coder_.kept, 32U);
  EXPECT_LT(result.keep_fraction, 1);
}

TEST_F(RateLoopTest, LearnsFromThinnedScansWhatAWholeOneTakes) {
  settings_.degradation = DegradationPreference::kMaintainFramerate;
  Encode(0);
  const double whole = loop_.controller().bounds().min.bits_per_second();
  for (std::uint32_t scan = 1; scan < 30; ++scan) {
    coder_.kept = coder_.rows;
    const LoopResult result = Encode(scan, DataRate::BitsPerSecond(whole / 4));
    EXPECT_TRUE(result.skipped || result.keep_fraction < 1);
  }
  EXPECT_NEAR(loop_.controller().bounds().min.bits_per_second() / whole, 1, 0.25);
}

TEST_F(RateLoopTest, SaysInEachResultWhatItWasMadeWith) {
  for (const double target : {1.0, 5e3, 5e4, 1e9}) {
    settings_.max_error_m = 0.03;
    const LoopResult result =
        Encode(static_cast<std::uint32_t>(target), DataRate::BitsPerSecond(target));
    EXPECT_EQ(result.mode, "fake");
    EXPECT_DOUBLE_EQ(result.max_error_m, 0.03) << target;
  }
}

TEST_F(RateLoopTest, PassesOnWhatTheCoderCouldNotEncode) {
  for (const CodingResult bad : {CodingResult::kEmpty, CodingResult::kOutOfReach}) {
    coder_.result = bad;
    const LoopResult result = Encode(0);
    EXPECT_FALSE(result.encoded());
    EXPECT_EQ(result.result, bad);
  }
}

}  // namespace
}  // namespace lidar::rate
