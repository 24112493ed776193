// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/start_states.h"

#include <algorithm>
#include <memory>

#include "src/base/base64.h"
#include "src/codec/mixing/binary_coder.h"
#include "src/codec/start_table.h"

namespace lidar::codec::mixing {
namespace {

// The logits in the table are multiples of this step.
constexpr std::int32_t kLogitStep = 160;
constexpr std::int32_t kMostLogitSteps = 12;
/// The rates that counters in the table may have: those after 0, 8, 16 and 32 bits.
constexpr std::array<std::uint16_t, 4> kRates = {RateAfter(0), RateAfter(8), RateAfter(16),
                                                 RateAfter(32)};
constexpr std::int32_t kWeightStep = 256;
constexpr std::int32_t kMostWeightSteps = 127;
constexpr std::int32_t kSpreadStep = 64;
constexpr std::int16_t kFirstWeight = kWeightOne * 3 / 10;

std::int32_t LogitSteps(const Counter& counter) {
  const std::int32_t logit = Logit(counter.chance) + kLogitStep / 2 + kLogitStep * kMostLogitSteps;
  return std::clamp(logit / kLogitStep, 0, 2 * kMostLogitSteps) - kMostLogitSteps;
}
Counter FromSteps(std::int32_t steps, std::uint32_t rate_class) {
  Counter counter;
  if (rate_class == 0) return counter;
  counter.chance = static_cast<std::uint16_t>(Chance(steps * kLogitStep));
  counter.rate = kRates[rate_class];
  return counter;
}
std::uint32_t RateClass(unsigned rate) {
  std::uint32_t c = kRates.size() - 1;
  while (kRates[c] < rate) --c;
  return c;
}

/// Codes the numbers of the table, which have up to 8 bits. Each context has a binary tree of
/// counters. These adapt while the table is coded.
template <class Coder>
class TableCoder {
 public:
  explicit TableCoder(Coder* coder) : coder_(*coder) {}

  std::uint32_t Number(std::uint32_t value, unsigned bits, std::uint32_t context) {
    if (counters_.size() <= context) counters_.resize(context + 1);
    std::uint32_t node = 1;
    for (unsigned place = bits; place-- > 0;) {
      Counter& counter = counters_[context][node];
      const std::int32_t chance =
          std::clamp<std::int32_t>(counter.chance, kLeastChance, kMostChance);
      const bool bit = coder_.Code((value >> place & 1) != 0, chance);
      counter.Learn(bit);
      node = 2 * node + (bit ? 1 : 0);
    }
    return node - (1U << bits);
  }

  /// Codes `counters`, which has `nodes` counters for each context in turn. `before` has the
  /// counters of the previous class, which help to predict these, or is null.
  template <std::size_t kSize>
  void Counters(std::array<Counter, kSize>* counters, const std::array<Counter, kSize>* before,
                std::uint32_t place, unsigned nodes) {
    std::array<std::uint32_t, kSmallNodes> logits{};
    std::array<std::uint32_t, kSmallNodes> rates{};
    for (std::size_t i = 0; i < kSize; ++i) {
      Counter& counter = (*counters)[i];
      const std::size_t node = i % nodes;
      const Counter old = before == nullptr ? Counter{} : (*before)[i];
      const std::uint32_t old_rate = RateClass(old.rate);
      const std::uint32_t left = node == 0 ? 0 : rates[node - 1];
      rates[node] = Number(RateClass(counter.rate), 2,
                           ((place * 8 + static_cast<std::uint32_t>(node)) * 4 + old_rate) * 16 +
                               rates[node] * 4 + left);
      std::uint32_t steps = kMostLogitSteps;
      if (rates[node] > 0) {
        const std::uint32_t nearby =
            old_rate > 0 ? 32 + static_cast<std::uint32_t>(LogitSteps(old) + kMostLogitSteps)
                         : logits[node];
        steps = Number(static_cast<std::uint32_t>(LogitSteps(counter) + kMostLogitSteps), 5,
                       kLogits +
                           ((place * 8 + static_cast<std::uint32_t>(node)) * 4 + rates[node]) * 64 +
                           nearby);
        logits[node] = steps;
      }
      counter = FromSteps(static_cast<std::int32_t>(steps) - kMostLogitSteps, rates[node]);
    }
  }

  template <std::size_t kSize>
  void WeightSets(std::array<Weights, kSize>* sets, std::uint32_t place) {
    for (Weights& set : *sets) {
      for (unsigned i = 0; i < kInputs; ++i) {
        const std::int32_t half = kWeightStep / 2;
        const std::int32_t steps =
            (set.values[i] + half + (kMostWeightSteps + 1) * kWeightStep) / kWeightStep;
        const auto bounded = static_cast<std::uint32_t>(std::clamp(steps, 1, 255));
        const std::uint32_t coded = Number(bounded, 8, kWeights + place * kInputs + i);
        set.values[i] = static_cast<std::int16_t>(
            (static_cast<std::int32_t>(coded) - kMostWeightSteps - 1) * kWeightStep);
      }
    }
  }

  void Spreads(BinCounters* counters) {
    for (std::int32_t& spread : counters->spread) {
      const auto steps = static_cast<std::uint32_t>(spread / kSpreadStep);
      const std::uint32_t high = Number(std::min(steps, 511U) >> 4, 5, kSpread);
      const std::uint32_t low = Number(std::min(steps, 511U) & 15, 4, kSpread + 1);
      spread = static_cast<std::int32_t>(std::max(high << 4 | low, 2U)) * kSpreadStep;
    }
  }

 private:
  // The number of the first context of each kind.
  static constexpr std::uint32_t kLogits = 4'096;
  static constexpr std::uint32_t kWeights = 24'576;
  static constexpr std::uint32_t kSpread = 32'000;

  Coder& coder_;
  std::vector<std::array<Counter, 256>> counters_;
};

/// Writes all of `states` and rounds them to the values written. With a decoder, reads `states`.
template <class Coder>
void CodeAll(StartStates* states, Coder* coder) {
  TableCoder<Coder> table(coder);
  const BinCounters* before = nullptr;
  for (BinCounters& c : states->counters) {
    table.Counters(&c.mask, before ? &before->mask : nullptr, 0, 1);
    table.Counters(&c.range, before ? &before->range : nullptr, 1, kSmallNodes);
    table.Counters(&c.jump, before ? &before->jump : nullptr, 2, 1);
    table.Counters(&c.candidates, before ? &before->candidates : nullptr, 3, 1);
    table.Spreads(&c);
    before = &c;
  }
  for (BinWeights& w : states->weights) {
    table.WeightSets(&w.mask, 0);
    table.WeightSets(&w.range, 1);
    table.WeightSets(&w.event, 2);
    table.WeightSets(&w.jump, 3);
  }
  const LevelCounters* fewer = nullptr;
  for (LevelCounters& level : states->level_counters) {
    table.Counters(&level.small, fewer ? &fewer->small : nullptr, 4, kSmallNodes);
    table.Counters(&level.rest, fewer ? &fewer->rest : nullptr, 5, 1);
    fewer = &level;
  }
  for (auto& of_effort : states->level_weights) {
    for (LevelWeights& level : of_effort) {
      table.WeightSets(&level.uneven, 4);
      table.WeightSets(&level.surfaces, 5);
    }
  }
}

struct NoCoder {
  bool Code(bool bit, std::int32_t /*chance*/) { return bit; }
};

template <std::size_t kSize>
void SetAll(std::array<Weights, kSize>* sets, std::int16_t weight) {
  for (Weights& set : *sets) set.values.fill(weight);
}

}  // namespace

unsigned StepClassOf(std::int64_t step_mm) {
  unsigned c = 0;
  while (c < kStepClassEnds.size() && step_mm > kStepClassEnds[c]) ++c;
  return c;
}

void StartStates::Reset() {
  for (BinCounters& c : counters) {
    c = BinCounters{};
    c.spread.fill(4'096);
  }
  for (BinWeights& w : weights) {
    SetAll(&w.mask, kFirstWeight);
    SetAll(&w.range, kFirstWeight);
    SetAll(&w.event, kFirstWeight);
    SetAll(&w.jump, kFirstWeight);
  }
  for (LevelCounters& level : level_counters) level = LevelCounters{};
  for (auto& of_effort : level_weights) {
    for (LevelWeights& level : of_effort) {
      SetAll(&level.uneven, kFirstWeight);
      SetAll(&level.surfaces, kFirstWeight);
    }
  }
}

void StartStates::Round() {
  NoCoder none;
  CodeAll(this, &none);
}

void StartStates::Write(std::vector<std::uint8_t>* out) const {
  const auto copy = std::make_unique<StartStates>(*this);
  BinaryEncoder encoder(out);
  CodeAll(copy.get(), &encoder);
  encoder.Finish();
}

bool StartStates::Read(ByteView table) {
  Reset();
  BinaryDecoder decoder(table);
  CodeAll(this, &decoder);
  return decoder.AtEnd();
}

std::vector<std::uint8_t> CommittedTable() { return FromBase64(kTableText); }

const StartStates& Trained() {
  static const std::unique_ptr<const StartStates> states = [] {
    auto read = std::make_unique<StartStates>();
    const std::vector<std::uint8_t> table = CommittedTable();
    // Read() does not fail, because a test makes sure that the table can be read.
    if (!read->Read({table.data(), table.size()})) read->Reset();
    return read;
  }();
  return *states;
}

}  // namespace lidar::codec::mixing
