// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/lanes.h"

#include <gtest/gtest.h>

#include <random>

#include "src/codec/mixing/bit_mixer.h"

namespace lidar::codec::mixing {
namespace {

/// An encoder that writes nothing and only records the chances that it is given.
struct Script {
  static constexpr bool kDecodes = false;
  bool Code(bool bit, std::int32_t chance) {
    chances.push_back(chance);
    return bit;
  }
  std::vector<std::int32_t> chances;
};

/// The state that a mixer has learnt.
template <unsigned kCounters>
struct Learnt {
  std::array<Counter, 4 * kCounters> counters{};
  std::array<Weights, 4> weights{};
  ChanceMap map;
  Script script;

  bool operator==(const Learnt& other) const {
    for (std::size_t i = 0; i < counters.size(); ++i)
      if (counters[i].rate != other.counters[i].rate ||
          counters[i].chance != other.counters[i].chance)
        return false;
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (weights[i].values != other.weights[i].values) return false;
    return script.chances == other.script.chances;
  }
};

/// Learns random bits. In each thousand bits, most bits are equal, so that the chances of the
/// counters reach both limits. The weights start with random values.
template <class Lanes, unsigned kCounters, unsigned kExtra>
Learnt<kCounters> Learn(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random);
  };
  Learnt<kCounters> l;
  for (Weights& weights : l.weights)
    for (std::int16_t& weight : weights.values)
      weight = static_cast<std::int16_t>(between(-32'768, 32'767));
  BitMixer<kCounters, kExtra, Lanes> mixer;
  for (unsigned i = 0; i < 5'000; ++i) {
    const bool bit = between(0, 99) < (i / 1'000 % 2 == 0 ? 1 : 90);
    const auto counter_at = [&](unsigned k) {
      return &l.counters[4 * k + static_cast<unsigned>(between(0, 3))];
    };
    mixer.Ask(counter_at, [&](unsigned) { return between(-3'000, 3'000); });
    if (i % 3 == 0) {
      mixer.Code(bit, &l.weights[0], &l.script);
    } else if (i % 3 == 1) {
      mixer.CodeFast(bit, std::array{&l.weights[0], &l.weights[1], &l.weights[2]},
                     i % 2 == 0 ? &l.map : nullptr, &l.script);
    } else {
      mixer.Code(bit, &l.weights[1], &l.weights[2 + i % 4 / 2], &l.script);
    }
  }
  return l;
}

TEST(Lanes, DoWhatThePlainOnesDo) {
  for (const unsigned seed : {1U, 2U}) {
    EXPECT_TRUE((Learn<PlainLanes, 3, 0>(seed) == Learn<FastLanes, 3, 0>(seed)));
    EXPECT_TRUE((Learn<PlainLanes, 5, 2>(seed) == Learn<FastLanes, 5, 2>(seed)));
    EXPECT_TRUE((Learn<PlainLanes, 8, 0>(seed) == Learn<FastLanes, 8, 0>(seed)));
    EXPECT_TRUE((Learn<PlainLanes, 8, 2>(seed) == Learn<FastLanes, 8, 2>(seed)));
    EXPECT_TRUE((Learn<PlainLanes, 13, 2>(seed) == Learn<FastLanes, 13, 2>(seed)));
    EXPECT_TRUE((Learn<PlainLanes, 14, 0>(seed) == Learn<FastLanes, 14, 0>(seed)));
  }
}

template <class Lanes>
std::int32_t LargestTotal(std::int16_t input, std::int16_t weight) {
  std::array<std::int16_t, kLanes> inputs;
  inputs.fill(input);
  alignas(32) std::array<std::int16_t, kLanes> weights;
  weights.fill(weight);
  const auto sum = Lanes::Dot(Lanes::Of(inputs), weights.data());
  return Lanes::Total(Lanes::Plus(sum, sum));
}

TEST(Lanes, AddUpTheLargestNumbers) {
  for (const std::int16_t input : {std::int16_t{-2'047}, std::int16_t{2'047}}) {
    for (const std::int16_t weight : {std::int16_t{-32'768}, std::int16_t{32'767}}) {
      EXPECT_EQ(LargestTotal<FastLanes>(input, weight), 16 * input * weight);
      EXPECT_EQ(LargestTotal<PlainLanes>(input, weight), 16 * input * weight);
    }
  }
}

TEST(AChanceMap, LearnsWhatChancesTurnOutToBe) {
  ChanceMap map;
  for (const std::int32_t logit : {-3'000, -700, 0, 5, 2'047})
    EXPECT_NEAR(map.Refined(logit), Chance(logit), 400) << logit;
  for (int i = 0; i < 4'000; ++i) map.Learn(300, i % 4 == 0);
  EXPECT_NEAR(map.Refined(256), (Chance(256) + 16'384) / 2, 1'500);
  EXPECT_NEAR(map.Refined(600), Chance(600), 400);  // Other chances stay the same.
  for (int i = 0; i < 4'000; ++i) map.Learn(-2'047, false);
  EXPECT_GE(map.Refined(-2'047), kLeastChance);
}

TEST(ACounter, LearnsAboutAsTheMeanOfItsBits) {
  Counter counter;
  EXPECT_EQ(counter.Vote(2'047), 172);  // A new counter has little weight.
  for (int i = 0; i < 100; ++i) {
    counter.Learn(i % 4 == 0);
    EXPECT_NEAR(counter.rate, 65'536 / (i + 2.64), 0.12 * counter.rate) << i;
  }
  EXPECT_NEAR(counter.chance, 16'384, 700);
  EXPECT_NEAR(counter.Vote(-1'000), -985, 5);
  for (int i = 0; i < 5'000; ++i) counter.Learn(true);
  EXPECT_EQ(counter.rate, 255);
  EXPECT_EQ(counter.chance, 65'535 - 257);
  for (int i = 0; i < 5'000; ++i) counter.Learn(false);
  EXPECT_EQ(counter.chance, 257);
}

}  // namespace
}  // namespace lidar::codec::mixing
