// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/level_tree.h"

#include <algorithm>
#include <array>

#include "src/codec/mixing/binary_coder.h"
#include "src/codec/mixing/bit_mixer.h"

namespace lidar::codec::cloud {
namespace {

using mixing::BitMixer;
using mixing::Counter;
using mixing::Weights;

constexpr unsigned kNodes = 256;
constexpr unsigned kClasses = 32;  // classes of a level

/// Codes levels one after the other. The bits of a level are coded from the highest to the lowest.
class LevelModel {
 public:
  explicit LevelModel(unsigned bits) : bits_(bits), coarse_(bits > 5 ? bits - 5 : 0) {
    for (Weights& w : weights_) w.values.fill(mixing::kWeightOne / 3);
  }

  /// Codes and returns `level`. `last` is the previous level, and `mean` the mean level of the
  /// neighbours. `place` is 0 for the first point of a cell, else 1.
  template <class Coder>
  unsigned Code(unsigned level, unsigned last, unsigned mean, unsigned place, Coder* coder) {
    const std::array<std::uint32_t, 4> contexts = {
        (place * kClasses + (last >> coarse_)) * kNodes,
        (place * kClasses + (mean >> coarse_)) * kNodes,
        ((last >> coarse_) * kClasses + (mean >> coarse_)) * kNodes, place * kNodes};
    unsigned node = 1;
    for (unsigned bit = bits_; bit-- > 0;) {
      BitMixer<4, 0> mixer;
      mixer.Ask([&](unsigned k)
                    __attribute__((always_inline)) { return &counters_[k][contexts[k] + node]; });
      node = node << 1 | (mixer.Code((level >> bit & 1) != 0, &weights_[node], coder) ? 1U : 0U);
    }
    return node - (1U << bits_);
  }

 private:
  unsigned bits_;
  unsigned coarse_;
  std::array<std::array<Counter, kClasses * kClasses * kNodes>, 4> counters_{};
  std::array<Weights, kNodes> weights_{};
};

/// Returns the mean level of those neighbours of a cell that are already coded. If there are none,
/// returns `otherwise`.
unsigned MeanOf(const NodeMap& map, std::uint64_t key, const std::vector<std::uint8_t>& means,
                unsigned otherwise) {
  unsigned known = 0;
  unsigned sum = 0;
  for (const std::uint64_t step :
       {NodeMap::kStepX, NodeMap::kStepY, NodeMap::kStepZ, NodeMap::kStepX + NodeMap::kStepY}) {
    const std::uint32_t there = map.Find(key - step);
    if (there == NodeMap::kAbsent) continue;
    ++known;
    sum += means[there];
  }
  return known == 0 ? otherwise : sum / known;
}

}  // namespace

template <class Coder>
bool CodeLevels(const CellList& cells, unsigned bits, std::vector<std::uint8_t>* levels,
                Coder* coder) {
  const auto model = std::make_unique<LevelModel>(bits);
  NodeMap map;
  map.Reset(cells.codes.size());
  std::vector<std::uint8_t> means;
  std::size_t at = 0;
  unsigned last = 0;
  for (std::uint32_t i = 0; i < cells.codes.size(); ++i) {
    const std::uint64_t key = NodeMap::KeyOf(PositionOf(cells.codes[i]));
    const unsigned mean = MeanOf(map, key, means, last);
    std::uint64_t sum = 0;
    for (std::uint32_t k = 0; k < cells.counts[i]; ++k, ++at) {
      last = model->Code((*levels)[at], last, mean, k == 0 ? 0 : 1, coder);
      (*levels)[at] = static_cast<std::uint8_t>(last);
      sum += last;
      if (coder->overran()) return false;
    }
    last = static_cast<unsigned>(sum / cells.counts[i]);
    means.push_back(static_cast<std::uint8_t>(last));
    map.Add(key, i);
  }
  return true;
}

template bool CodeLevels(const CellList&, unsigned, std::vector<std::uint8_t>*,
                         mixing::BinaryEncoder*);
template bool CodeLevels(const CellList&, unsigned, std::vector<std::uint8_t>*,
                         mixing::BinaryDecoder*);

}  // namespace lidar::codec::cloud
