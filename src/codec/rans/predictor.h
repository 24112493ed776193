// SPDX-License-Identifier: LGPL-2.1-or-later
// Predicts the returns of a row from the returns around them that are already decoded.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "src/codec/azimuth_alignment.h"
#include "src/codec/rans/rans.h"

namespace lidar::codec {

/// What is known about a value before it is coded.
struct Prediction {
  std::int32_t value = 0;
  unsigned context = 0;     // how uneven the neighbourhood is, 0 .. kContexts - 1
  std::int32_t mirror = 0;  // -1: residuals are coded with their sign changed
};

constexpr unsigned kContexts = 15;

namespace detail {

/// Contexts by sums of absolute differences: a context for each half octave. The last one has no
/// upper limit.
struct ContextTable {
  static constexpr unsigned kMost = 128;
  constexpr ContextTable() {
    for (unsigned a = 0; a <= kMost; ++a) {
      unsigned log2 = 0;
      while (a >> (log2 + 1) != 0) ++log2;
      const unsigned context = a < 2 ? a : 2 * log2 + (a >> (log2 - 1) & 1);
      contexts[a] = static_cast<std::uint8_t>(context < kContexts ? context : kContexts - 1);
    }
  }
  std::uint8_t contexts[kMost + 1] = {};
};
inline constexpr ContextTable kContextTable;

}  // namespace detail

/// Differences and sums that wrap: values of damaged streams may be anything.
inline std::int32_t Sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
inline std::int32_t Difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

/// A value once it is coded.
struct Coded {
  std::int32_t value;
  std::int32_t magnitude;  // of the residual
};

/// Columns of the returns of one row, in order.
struct RowReturns {
  const std::uint16_t* columns;
  RowLanes lanes;
};

/// A channel (ranges or intensities) of a slice, row by row. The neighbours of a return are W, N,
/// NE and NW. W is the return to the left in the same lane. N and NE are in the nearest beams above
/// that have a return at their azimuths. NW is the N of W. The prediction is the median of W, N and
/// W + N - NW (the MED predictor of LOCO-I), which follows planes and keeps to one side of an edge.
///
/// All but W is known before the row is coded and is prepared for the whole row. The lanes of a row
/// do not wait for each other.
class RowPredictor {
 public:
  void Reset(const AzimuthAlignment& alignment, std::uint32_t columns);

  /// Calls code(lane, index, prediction) for all returns of a row in the order of coding. Returns
  /// false if a value is not below `limit`, a power of two; Reset() must then be called next.
  template <class Code>
  [[gnu::always_inline]] bool CodeRow(std::uint32_t beam, const RowReturns& row,
                                      std::uint32_t limit, Code&& code) {
    if (Prepare(beam, row)) {
      Walk<false>(row.lanes, code);
    } else {
      Walk<true>(row.lanes, code);
    }
    return Keep(beam, row, limit);
  }
  /// The values of the row that was coded last.
  const std::int32_t* values() const { return values_.data(); }

 private:
  static constexpr std::int32_t kUnknown = -1;
  /// Finds the neighbours above the row; returns false if there are none at all.
  bool Prepare(std::uint32_t beam, const RowReturns& row);
  bool Keep(std::uint32_t beam, const RowReturns& row, std::uint32_t limit);

  template <bool kBlind, class Code>
  [[gnu::always_inline]] void Walk(const RowLanes& lanes, Code&& code) {
    Return* const row = row_.data();
    std::int32_t west[kRansLanes];
    std::int32_t error[kRansLanes];
    for (unsigned lane = 0; lane < kRansLanes; ++lane) {
      const std::size_t start = lane < lanes.lanes ? lanes.Start(lane) : 0;
      west[lane] = kBlind ? latest_ : row[start].north;
      // No neighbour is known here, so the context is that of the largest errors.
      error[lane] = kBlind ? std::int32_t{detail::ContextTable::kMost} : 0;
    }
    ForEachInTurns(
        lanes, [&](unsigned lane, std::size_t i) __attribute__((always_inline)) {
          Return& at = row[i];
          const std::int32_t w = west[lane];
          // No comparisons here: a compiler could turn them into jumps, which would be
          // mispredicted.
          const std::int32_t to_north = kBlind ? 0 : Difference(at.north, w);
          const std::int32_t below = to_north & to_north >> 31;
          const std::int32_t above = to_north & ~(to_north >> 31);
          const std::int32_t step = kBlind ? 0 : at.gradient;
          Prediction p;
          p.value = Sum(w, std::min(std::max(step, below), above));
          const std::uint32_t uneven = static_cast<std::uint32_t>(above) -
                                       static_cast<std::uint32_t>(below) +
                                       static_cast<std::uint32_t>(kBlind ? 0 : at.uneven) +
                                       2 * static_cast<std::uint32_t>(error[lane]);
          p.context =
              detail::kContextTable.contexts[std::min(uneven, detail::ContextTable::kMost + 0U)];
          // A value that differs from the prediction tends towards the other neighbour, so the
          // sign of the difference has a meaning.
          p.mirror = -above >> 31;
          const Coded coded = code(lane, i, p);
          error[lane] = at.error = coded.magnitude;
          west[lane] = at.value = coded.value;
        });
  }

  struct Known {
    std::int32_t value = kUnknown;
    std::int32_t error = 0;  // size of its residual
  };
  /// A return of the row: its surroundings before it is coded, then its value and error.
  struct Return {
    union {
      std::int32_t north;
      std::int32_t value;
    };
    union {
      std::int32_t uneven;  // |N - NW| + |NE - N|, and twice the error of N
      std::int32_t error;
    };
    std::int32_t gradient;  // N - NW
  };

  AlignedRow<Known> above_;
  std::int32_t latest_ = 0;  // value of the latest return, for rows without any neighbour
  std::vector<Return> row_;
  std::vector<std::int32_t> values_;
};

}  // namespace lidar::codec
