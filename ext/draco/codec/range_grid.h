// SPDX-License-Identifier: LGPL-2.1-or-later
// The grid on which ranges are rounded, exact in the sensor's own unit.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lidar::codec {

/// Ranges are multiples of `unit_mm`; `cells` neighbouring values share a bin, and all of them come
/// back as the middle one. The error is at most (cells - 1) / 2 units, with no rounding on top.
class RangeGrid {
 public:
  static constexpr std::uint32_t kMaxCells = 65'535;
  static constexpr std::uint32_t kMaxUnitMm = 1'000;

  constexpr RangeGrid() = default;
  constexpr RangeGrid(std::uint32_t unit_mm, std::uint32_t cells)
      : unit_mm_(unit_mm), cells_(Whole(unit_mm, cells)) {}

  /// The coarsest grid whose error stays within `error_m`; lossless where none else does.
  static RangeGrid ForError(double error_m, std::uint32_t unit_mm) {
    // The small term lets a bound such as 0.02 m, which is no exact double, hold 40 units of 1 mm.
    const double units = std::floor(2e3 * error_m / unit_mm + 1e-9) + 1;
    return {unit_mm, static_cast<std::uint32_t>(std::clamp(units, 1.0, double{kMaxCells}))};
  }
  /// The coarsest grid whose step is at most `step_m`.
  static RangeGrid ForStep(double step_m, std::uint32_t unit_mm) {
    const double units = std::floor(1e3 * step_m / unit_mm + 1e-9);
    return {unit_mm, static_cast<std::uint32_t>(std::clamp(units, 1.0, double{kMaxCells}))};
  }

  bool IsValid() const {
    return unit_mm_ >= 1 && unit_mm_ <= kMaxUnitMm && cells_ >= 1 && cells_ <= kMaxCells &&
           cells_ == Whole(unit_mm_, cells_);
  }
  std::uint32_t unit_mm() const { return unit_mm_; }
  std::uint32_t cells() const { return cells_; }
  std::uint32_t step_mm() const { return unit_mm_ * cells_; }
  double step_m() const { return 1e-3 * step_mm(); }
  double error_m() const { return 0.5e-3 * (cells_ - 1) * unit_mm_; }

  std::uint32_t BinOf(std::uint32_t range_mm) const { return range_mm / step_mm(); }
  std::uint32_t RangeOf(std::uint32_t bin) const {
    return bin * step_mm() + (cells_ - 1) * unit_mm_ / 2;
  }

 private:
  /// Ranges are whole millimetres, so the middle of a bin has to be one as well.
  static constexpr std::uint32_t Whole(std::uint32_t unit_mm, std::uint32_t cells) {
    return (cells - 1) * unit_mm % 2 == 0 ? cells : cells - 1;
  }

  std::uint32_t unit_mm_ = 1;
  std::uint32_t cells_ = 1;
};

}  // namespace lidar::codec
