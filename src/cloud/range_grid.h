// SPDX-License-Identifier: LGPL-2.1-or-later
// The grid for rounding ranges: has any step, and an exact bound of the error.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lidar {

/// Ranges are multiples of `unit_mm`, here called cells. Neighbouring cells share a bin and decode
/// to its middle, rounded up to a whole millimetre. A step that is not a whole number of cells
/// makes bins of two sizes, evenly mixed, so that encoded sizes change as smoothly as the step
/// does. The error is that of the larger bins.
class RangeGrid {
 public:
  static constexpr std::uint32_t kMaxCells = 65'535;
  static constexpr std::uint32_t kMaxUnitMm = 1'000;
  /// Greatest range for which sums and differences of bins fit an int32.
  static constexpr std::uint32_t kMaxRangeMm = (1U << 28) - 1;
  /// Number of parts of a cell; steps are multiples of a part.
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

  /// Returns the coarsest grid whose error stays within `error_m`, or the lossless grid if there is
  /// none.
  static RangeGrid ForError(double error_m, std::uint32_t unit_mm) {
    // The small term turns a bound such as 0.02 m, which is not an exact double, into 20 mm.
    // Fractions of a millimetre do not matter, because errors are whole millimetres.
    const double whole_mm = std::floor(1e3 * error_m + 1e-9);
    const double cells = std::floor(2 * whole_mm / unit_mm) + 1;
    return {unit_mm, static_cast<std::uint32_t>(std::clamp(cells, 1.0, double{kMaxCells}))};
  }
  /// Returns the coarsest grid whose step is at most `step_m`, or the lossless grid if there is
  /// none.
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
  /// The step in cells / kParts.
  std::uint32_t parts() const { return parts_; }
  double step_m() const { return 1e-3 / kParts * parts_ * unit_mm_; }
  /// Number of cells in each of the larger bins.
  std::uint32_t largest_bin() const { return (parts_ + kParts - 1) / kParts; }
  /// The largest distance between a range and RangeOf(BinOf(range)).
  double error_m() const {
    const std::uint32_t error_mm = ((largest_bin() - 1) * unit_mm_ + 1) / 2;
    return 1e-3 * error_mm;
  }

  std::uint32_t BinOf(std::uint32_t range_mm) const {
    return static_cast<std::uint32_t>(std::uint64_t{range_mm / unit_mm_} * kParts / parts_);
  }
  /// BinOf() of many ranges, without divisions.
  class BinFinder {
   public:
    explicit BinFinder(const RangeGrid& grid)
        : per_mm_(1.0 / grid.unit_mm_), per_part_(1.0 / grid.parts_) {}
    /// `range_mm` is up to kMaxRangeMm.
    std::uint32_t Of(std::uint32_t range_mm) const {
      // Adding a half keeps a quotient so far from an integer that rounding cannot change it.
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
  /// Returns true if `bin` decodes to a range, not 0, within `error_mm` of `range_mm`.
  bool ComesBackWithin(std::uint32_t error_mm, std::uint32_t bin, std::uint32_t range_mm) const {
    const std::uint32_t back = RangeOf(bin);
    return back > 0 && (back > range_mm ? back - range_mm : range_mm - back) <= error_mm;
  }
  /// Replaces each bin by RangeOf(bin). Returns false if a range is above kMaxRangeMm.
  bool ToRanges(std::vector<std::int32_t>* bins) const {
    std::uint32_t last = 0;
    for (const std::int32_t bin : *bins) last |= static_cast<std::uint32_t>(bin);
    // The OR of all bins is at least the largest bin, and less than twice the largest bin.
    const std::uint64_t parts = (last + std::uint64_t{1}) * parts_ + kParts;
    // Usually 32 bits suffice, and a processor can compute several numbers at once.
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
  /// Returns the middle of a bin's cells. Cells belong to the bin in which they begin.
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
