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

/// The prediction of a value, made before the value is coded.
struct Prediction {
  std::int32_t value = 0;
  unsigned context = 0;     // how uneven the neighbourhood is, 0 .. kContexts - 1
  std::int32_t mirror = 0;  // -1: residuals are coded with their sign changed
};

constexpr unsigned kContexts = 15;

namespace detail {

/// The context for each sum of absolute differences. There is a context for each half octave. The
/// last context has no upper limit.
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

/// Sum() and Difference() wrap around, because values of damaged streams may be of any size.
inline std::int32_t Sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
inline std::int32_t Difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

/// A value after it was coded.
struct Coded {
  std::int32_t value;
  std::int32_t magnitude;  // of the residual
};

/// The columns of the returns of one row, in order, and their division into lanes.
struct RowReturns {
  const std::uint16_t* columns;
  RowLanes lanes;
};

/// Predicts a channel (ranges or intensities) of a slice, row by row.
///
/// The neighbours of a return are W, N, NE and NW. W is the return before it in the same lane. N is
/// above the return, and NE above the pixel to its right: each is in the nearest beam above that
/// has a return there. NW is the N of W. The prediction is the median of W, N and W + N - NW (the
/// MED predictor of LOCO-I). On a plane it follows the plane, and at an edge it keeps to one side.
///
/// All neighbours but W are known before a row is coded, and are prepared for the whole row. No
/// lane depends on another lane of the same row.
class RowPredictor {
 public:
  void Reset(const AzimuthAlignment& alignment, std::uint32_t columns);

  /// Calls code(lane, index, prediction) for all returns of a row, in the order of coding. `limit`
  /// is a power of two. Returns false if a value is not below it. In this case, Reset() must be
  /// called before the next row.
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
  /// Returns the values of the row that was coded last.
  const std::int32_t* values() const { return values_.data(); }

 private:
  static constexpr std::int32_t kUnknown = -1;
  /// Finds the neighbours in the beams above. Returns false if the whole row has none.
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
      // The first predictions are poor without neighbours. They have the context of the largest
      // errors.
      error[lane] = kBlind ? std::int32_t{detail::ContextTable::kMost} : 0;
    }
    ForEachInTurns(
        lanes, [&](unsigned lane, std::size_t i) __attribute__((always_inline)) {
          Return& at = row[i];
          const std::int32_t w = west[lane];
          // There are no comparisons here, because a compiler could turn them into jumps, which a
          // processor would mispredict.
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
          // The prediction is often W or N. A different value is mostly on the side of the other of
          // these two neighbours, so the mirrored sign of the difference is predictable.
          p.mirror = -above >> 31;
          const Coded coded = code(lane, i, p);
          error[lane] = at.error = coded.magnitude;
          west[lane] = at.value = coded.value;
        });
  }

  struct Known {
    std::int32_t value = kUnknown;
    std::int32_t error = 0;  // magnitude of its residual
  };
  /// A return of the row. Before it is coded, `north`, `uneven` and `gradient` describe its
  /// neighbours. Afterwards, `value` and `error` are set.
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
