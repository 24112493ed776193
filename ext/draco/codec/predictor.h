// SPDX-License-Identifier: LGPL-2.1-or-later
// Predicts each return from those around it that the decoder knows already.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "draco/codec/azimuth_alignment.h"
#include "draco/codec/mask_coder.h"

namespace lidar::codec {

/// What is known before a value.
struct Prediction {
  std::int32_t value = 0;
  unsigned context = 0;   // how uneven the neighbourhood is, 0 .. kContexts - 1
  bool mirrored = false;  // residuals are coded with their sign changed: see Neighbourhood
};

constexpr unsigned kContexts = 16;

/// One channel (ranges or intensities) of a slice, beam by beam. The neighbours of a return are the
/// one to its left, W, and N, NE and NW in the nearest beam above that has a return at the same
/// azimuth; NW is the one above W. The prediction is the median of W, N and W + N - NW (the MED
/// predictor of LOCO-I), which follows planes and keeps to one side of an edge.
class Neighbourhood {
 public:
  void Reset(const AzimuthAlignment& alignment, std::uint32_t columns) {
    values_.Reset(alignment, columns, kUnknown);
    errors_.Reset(alignment, columns, 0);
    start_ = 0;
  }
  void StartBeam(std::uint32_t beam) {
    above_ = values_.At(beam);
    errors_above_ = errors_.At(beam);
    west_ = kUnknown;
    north_west_ = kUnknown;
    error_ = 0;
  }
  void EndBeam(std::uint32_t beam) {
    values_.CloseTurn(beam);
    errors_.CloseTurn(beam);
  }

  Prediction Predict(std::uint32_t column) const {
    std::int32_t n = above_[column];
    std::int32_t w = west_;
    n = n == kUnknown ? w : n;
    w = w == kUnknown ? n : w;
    if (n == kUnknown) return {start_, kContexts - 1, false};
    std::int32_t nw = north_west_ == kUnknown ? n : north_west_;
    std::int32_t ne = above_[column + 1];
    ne = ne == kUnknown ? n : ne;
    const std::int32_t low = std::min(w, n);
    const std::int32_t high = std::max(w, n);
    Prediction p;
    p.value = std::clamp(w + n - nw, low, high);
    const std::int32_t unevenness =
        std::min(high - low, kMost) + std::min(std::abs(n - nw), kMost) +
        std::min(std::abs(ne - n), kMost) + 2 * std::min(error_, kMost) +
        2 * std::min(errors_above_[column], kMost);
    p.context = ContextOf(static_cast<std::uint32_t>(unevenness));
    // Where it is off, the value tends towards the other neighbour; so the sign has a meaning.
    p.mirrored = n > w;
    return p;
  }
  void Set(std::uint32_t column, std::int32_t value, std::int32_t predicted) {
    error_ = std::abs(value - predicted);
    north_west_ = above_[column];
    west_ = value;
    above_[column] = value;
    errors_above_[column] = error_;
    start_ = value;
  }

 private:
  static constexpr std::int32_t kUnknown = -1;
  static constexpr std::int32_t kMost = 1 << 20;
  static unsigned ContextOf(std::uint32_t unevenness);

  AlignedRow<std::int32_t> values_;
  AlignedRow<std::int32_t> errors_;
  std::int32_t* above_ = nullptr;
  std::int32_t* errors_above_ = nullptr;
  std::int32_t west_ = kUnknown;
  std::int32_t north_west_ = kUnknown;
  std::int32_t error_ = 0;
  std::int32_t start_ = 0;  // the latest value, for beams without any neighbour
};

/// Half-octaves of a sum of absolute differences.
inline unsigned Neighbourhood::ContextOf(std::uint32_t unevenness) {
  if (unevenness < 2) return unevenness;
  const unsigned log2 = 31 - static_cast<unsigned>(__builtin_clz(unevenness));
  const unsigned half = unevenness >> (log2 - 1) & 1;
  return std::min(2 * log2 + half, kContexts - 2);
}

}  // namespace lidar::codec
