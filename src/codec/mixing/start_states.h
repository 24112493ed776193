// SPDX-License-Identifier: LGPL-2.1-or-later
// Initial counters and weights of a slice, trained on real scans. They are part of the format
// (docs/mixing-coder.md).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/codec/mixing/model.h"

namespace lidar::codec::mixing {

constexpr std::uint8_t kTableVersion = 2;
/// Payloads of refined models, which begin with the same states.
constexpr std::uint8_t kRefinedVersion = 3;
constexpr unsigned kEfforts = 3;

/// Largest bin width [mm] of each class but the last. Each class has counters of its own.
constexpr std::array<std::int64_t, 4> kStepClassEnds = {11, 29, 69, 139};
constexpr unsigned kStepClasses = kStepClassEnds.size() + 1;
unsigned StepClassOf(std::int64_t step_mm);

/// Intensities of up to 6 bits are one class, those of more bits the other.
constexpr unsigned kLevelClasses = 2;
inline unsigned LevelClassOf(unsigned bits) { return bits > 6 ? 1 : 0; }

/// The trained states.
struct StartStates {
  std::array<BinCounters, kStepClasses> counters;
  std::array<BinWeights, kEfforts> weights;
  std::array<LevelCounters, kLevelClasses> level_counters;
  std::array<std::array<LevelWeights, kLevelClasses>, kEfforts> level_weights;

  /// Sets all chances to a half, and all weights alike.
  void Reset();
  /// Rounds to values that a table can hold. A counter then has the rate of one with few bits, so a
  /// slice can still change it.
  void Round();
  /// Appends the table of rounded states.
  void Write(std::vector<std::uint8_t>* out) const;
  /// Returns false if `table` is anything but a whole table.
  bool Read(ByteView table);

  /// Sets `model` to the initial states. If `level_bits` is 0, its models of levels do not change.
  void CopyTo(unsigned effort, std::int64_t step_mm, unsigned level_bits, Model* model) const {
    model->counters = counters[StepClassOf(step_mm)];
    model->weights = weights[effort - 1];
    if (level_bits == 0) return;
    model->level_counters = level_counters[LevelClassOf(level_bits)];
    model->level_weights = level_weights[effort - 1][LevelClassOf(level_bits)];
  }
};

/// The states of this version, from the table that is compiled in.
const StartStates& Trained();

/// The table (start_table.txt) that StartStates::Write() made.
std::vector<std::uint8_t> CommittedTable();

}  // namespace lidar::codec::mixing
