// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/mixer.h"

#include <gtest/gtest.h>

#include <random>

namespace lidar::codec::mixing {
namespace {

void Set(Inputs* inputs, unsigned place, std::int32_t logit) {
  inputs->packed[place / 4] |= Inputs::Packed(place, logit);
}

class EachKernel : public testing::TestWithParam<const Kernel*> {
 protected:
  std::int32_t Between(std::int32_t least, std::int32_t most) {
    return std::uniform_int_distribution<std::int32_t>(least, most)(random_);
  }
  Inputs RandomInputs() {
    Inputs inputs;
    for (unsigned i = 0; i < kInputs; ++i) Set(&inputs, i, Between(-kMostLogit, kMostLogit));
    return inputs;
  }
  Weights RandomWeights() {
    Weights weights;
    for (auto& weight : weights.values) weight = Between(-kMostWeight, kMostWeight);
    return weights;
  }
  std::mt19937 random_{7};
};

std::int32_t Dot(const Kernel& kernel, const Inputs& inputs, const Weights& weights) {
  const auto [a, b, c, d] = inputs.packed;
  return kernel.dot(a, b, c, d, &weights);
}

TEST(Inputs, GiveBackTheirLogits) {
  Inputs inputs;
  for (unsigned i = 0; i < kInputs; ++i)
    Set(&inputs, i, static_cast<std::int32_t>(i * 255) - 2'047);
  for (unsigned i = 0; i < kInputs; ++i)
    EXPECT_EQ(inputs.At(i), static_cast<std::int32_t>(i * 255) - 2'047);
}

TEST_P(EachKernel, AddsUpAsTheScalarOne) {
  for (int i = 0; i < 1'000; ++i) {
    const Inputs inputs = RandomInputs();
    const Weights first = RandomWeights();
    const Weights second = RandomWeights();
    const auto [a, b, c, d] = inputs.packed;
    const Sums sums = GetParam()->dots(a, b, c, d, &first, &second);
    ASSERT_EQ(sums.first, Dot(kScalarKernel, inputs, first));
    ASSERT_EQ(sums.second, Dot(kScalarKernel, inputs, second));
    ASSERT_EQ(sums.first, Dot(*GetParam(), inputs, first));
  }
}

TEST_P(EachKernel, AddsUpTheLargestNumbers) {
  for (const std::int32_t sign : {-1, 1}) {
    Inputs inputs;
    for (unsigned i = 0; i < kInputs; ++i) Set(&inputs, i, sign * kMostLogit);
    Weights weights;
    weights.values.fill(kMostWeight);
    EXPECT_EQ(Dot(*GetParam(), inputs, weights), Dot(kScalarKernel, inputs, weights));
  }
}

TEST_P(EachKernel, LearnsAsTheScalarOne) {
  Weights weights = RandomWeights();
  Weights expected = weights;
  for (int i = 0; i < 10'000; ++i) {
    const auto [a, b, c, d] = RandomInputs().packed;
    const std::int32_t step = StepOf(Between(0, 1) == 1, Between(kLeastChance, kMostChance));
    GetParam()->learn(a, b, c, d, step, &weights);
    kScalarKernel.learn(a, b, c, d, step, &expected);
    ASSERT_EQ(weights.values, expected.values) << i;
  }
}

std::vector<const Kernel*> Kernels() {
  std::vector<const Kernel*> kernels;
  for (const Kernel* kernel : AllKernels())
    if (kernel != nullptr) kernels.push_back(kernel);
  return kernels;
}
INSTANTIATE_TEST_SUITE_P(OfThisProcessor, EachKernel, testing::ValuesIn(Kernels()),
                         [](const auto& kernel) { return kernel.param->name; });

}  // namespace
}  // namespace lidar::codec::mixing
