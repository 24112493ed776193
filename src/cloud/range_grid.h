// SPDX-License-Identifier: LGPL-2.1-or-later
// A grid for rounding ranges. It supports any step, and its error has an exact bound.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lidar {

/// Ranges are counted in cells of `unit_mm`. Neighbouring cells form a bin. A bin is decoded to its
/// middle, rounded up to a whole millimetre. If the step is not a whole number of cells, the grid
/// has bins of two sizes, evenly mixed. So the encoded size changes smoothly if the step changes.
/// The error bound is the error of the larger bins.
class RangeGrid {
 public:
  static constexpr std::uint32_t kMaxCells = 65'535;
  static constexpr std::uint32_t kMaxUnitMm = 1'000;
  /// The greatest range for which the sum and the difference of two bins fit an int32.
  static constexpr std::uint32_t kMaxRangeMm = (1U << 28) - 1;
  /// The number of parts of a cell. Steps are multiples of a part.
  static constexpr std::uint32_t kParts = 256;

  constexpr RangeGrid() = default;
  constexpr RangeGrid(std::uint32_t unit_mm, std::uint32_t cells)
      : unit_mm_(unit_mm), parts_(cells * kParts) {}
  static constexpr RangeGrid OfParts(std::uint32_t unit_mm, std::uint32_t parts) {
    RangeGrid grid;
    grid.unit_mm_ = unit_mm;
    grid.parts_ = parts;
    return grid;
  }

  /// Returns the coarsest grid whose error is at most `error_m`. If there is none, returns the
  /// lossless grid.
  static RangeGrid ForError(double error_m, std::uint32_t unit_mm) {
    // The small term makes a bound such as 0.02 m, which is not an exact double, count as 20 mm.
    // Fractions of a millimetre are ignored, because errors are whole millimetres.
    const double whole_mm = std::floor(1e3 * error_m + 1e-9);
    const double cells = std::floor(2 * whole_mm / unit_mm) + 1;
    return {unit_mm, static_cast<std::uint32_t>(std::clamp(cells, 1.0, double{kMaxCells}))};
  }
  /// Returns the coarsest grid whose step is at most `step_m`. If there is none, returns the
  /// lossless grid.
  static RangeGrid ForStep(double step_m, std::uint32_t unit_mm) {
    const double parts = std::floor(1e3 * kParts * step_m / unit_mm + 1e-6);
    constexpr double kMost = double{kMaxCells} * kParts;
    return OfParts(unit_mm, static_cast<std::uint32_t>(std::clamp(parts, double{kParts}, kMost)));
  }

  bool IsValid() const {
    return unit_mm_ >= 1 && unit_mm_ <= kMaxUnitMm && parts_ >= kParts &&
           parts_ <= kMaxCells * kParts;
  }
  std::uint32_t unit_mm() const { return unit_mm_; }
  /// Returns the step in units of 1 / kParts cells.
  std::uint32_t parts() const { return parts_; }
  double step_m() const { return 1e-3 / kParts * parts_ * unit_mm_; }
  /// Returns the number of cells in the larger bins.
  std::uint32_t largest_bin() const { return (parts_ + kParts - 1) / kParts; }
  /// Returns the largest possible distance between a range and RangeOf(BinOf(range)).
  double error_m() const {
    const std::uint32_t error_mm = ((largest_bin() - 1) * unit_mm_ + 1) / 2;
    return 1e-3 * error_mm;
  }

  std::uint32_t BinOf(std::uint32_t range_mm) const {
    return static_cast<std::uint32_t>(std::uint64_t{range_mm / unit_mm_} * kParts / parts_);
  }
  /// Computes BinOf() for many ranges, without divisions.
  class BinFinder {
   public:
    explicit BinFinder(const RangeGrid& grid)
        : per_mm_(1.0 / grid.unit_mm_), per_part_(1.0 / grid.parts_) {}
    /// Requires that `range_mm` is at most kMaxRangeMm.
    std::uint32_t Of(std::uint32_t range_mm) const {
      // Adding 0.5 keeps the quotient away from integers, so that its rounding error cannot change
      // the bin.
      const auto cells =
          static_cast<std::int32_t>((static_cast<std::int32_t>(range_mm) + 0.5) * per_mm_);
      return static_cast<std::uint32_t>(
          static_cast<std::int32_t>((cells * double{kParts} + 0.5) * per_part_));
    }

   private:
    double per_mm_;
    double per_part_;
  };
  std::uint32_t RangeOf(std::uint32_t bin) const {
    return static_cast<std::uint32_t>(Middle<std::uint64_t>(bin));
  }
  /// Returns true if `bin` is decoded to a range that is not 0 and differs from `range_mm` by at
  /// most `error_mm`.
  bool ComesBackWithin(std::uint32_t error_mm, std::uint32_t bin, std::uint32_t range_mm) const {
    const std::uint32_t back = RangeOf(bin);
    return back > 0 && (back > range_mm ? back - range_mm : range_mm - back) <= error_mm;
  }
  /// Replaces each bin by RangeOf(bin). Returns false if a resulting range would exceed
  /// kMaxRangeMm.
  bool ToRanges(std::vector<std::int32_t>* bins) const {
    std::uint32_t last = 0;
    for (const std::int32_t bin : *bins) last |= static_cast<std::uint32_t>(bin);
    // The bitwise OR of all bins is at least the largest bin, and less than twice the largest bin.
    const std::uint64_t parts = (last + std::uint64_t{1}) * parts_ + kParts;
    // Usually numbers of 32 bits are large enough, which lets the compiler use vector instructions.
    if (parts <= UINT32_MAX && 2 * unit_mm_ * (parts / kParts + 1) <= kMaxRangeMm) {
      for (std::int32_t& bin : *bins)
        bin = static_cast<std::int32_t>(Middle<std::uint32_t>(static_cast<std::uint32_t>(bin)));
      return true;
    }
    const std::uint32_t last_bin = BinOf(kMaxRangeMm);
    for (std::int32_t& bin : *bins) {
      if (static_cast<std::uint32_t>(bin) > last_bin) return false;
      bin = static_cast<std::int32_t>(RangeOf(static_cast<std::uint32_t>(bin)));
    }
    return true;
  }

 private:
  /// Returns the middle of the cells in a bin. A cell belongs to the bin in which it begins.
  template <class Wide>
  Wide Middle(Wide bin) const {
    const Wide first = (bin * parts_ + (kParts - 1)) / kParts;
    const Wide next = ((bin + 1) * parts_ + (kParts - 1)) / kParts;
    return ((first + next - 1) * unit_mm_ + 1) / 2;
  }

  std::uint32_t unit_mm_ = 1;
  std::uint32_t parts_ = kParts;
};

}  // namespace lidar
