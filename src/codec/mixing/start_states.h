// SPDX-License-Identifier: LGPL-2.1-or-later
// The initial counters and weights of a slice. They were trained on real scans, and are part of the
// format (docs/mixing-coder.md).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/codec/mixing/model.h"

namespace lidar::codec::mixing {

constexpr std::uint8_t kTableVersion = 2;
/// The version of payloads with refined models. These begin with the states of the same table.
constexpr std::uint8_t kRefinedVersion = 3;
constexpr unsigned kEfforts = 3;

/// The largest bin width [mm] of each class except the last. Each class has its own counters.
constexpr std::array<std::int64_t, 4> kStepClassEnds = {11, 29, 69, 139};
constexpr unsigned kStepClasses = kStepClassEnds.size() + 1;
unsigned StepClassOf(std::int64_t step_mm);

/// Levels of up to 6 bits have class 0, levels of more bits class 1.
constexpr unsigned kLevelClasses = 2;
inline unsigned LevelClassOf(unsigned bits) { return bits > 6 ? 1 : 0; }

/// The trained states.
struct StartStates {
  std::array<BinCounters, kStepClasses> counters;
  std::array<BinWeights, kEfforts> weights;
  std::array<LevelCounters, kLevelClasses> level_counters;
  std::array<std::array<LevelWeights, kLevelClasses>, kEfforts> level_weights;

  /// Sets all chances to a half, and all weights to the same value.
  void Reset();
  /// Rounds the states to values that a table can have. Each counter then has the rate of a counter
  /// that has seen at most 32 bits, so it still adapts to a slice.
  void Round();
  /// Appends the table to `out`. The table has the states after rounding.
  void Write(std::vector<std::uint8_t>* out) const;
  /// Reads the states from `table`. Returns false if `table` is truncated or has further bytes.
  bool Read(ByteView table);

  /// Sets `model` to the initial states. If `level_bits` is 0, the models of levels do not change.
  void CopyTo(unsigned effort, std::int64_t step_mm, unsigned level_bits, Model* model) const {
    model->counters = counters[StepClassOf(step_mm)];
    model->weights = weights[effort - 1];
    if (level_bits == 0) return;
    model->level_counters = level_counters[LevelClassOf(level_bits)];
    model->level_weights = level_weights[effort - 1][LevelClassOf(level_bits)];
  }
};

/// Returns the start states that are compiled into this library.
const StartStates& Trained();

/// Returns the table (start_table.txt) that StartStates::Write() made.
std::vector<std::uint8_t> CommittedTable();

}  // namespace lidar::codec::mixing
