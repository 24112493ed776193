// SPDX-License-Identifier: LGPL-2.1-or-later
// The bytes that each slice of the current scan needs at least, and can use at most.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace lidar::rate {

constexpr unsigned kMaxIntensityBits = 16;

/// Predicted bytes of a slice or of several slices.
struct Demand {
  double coarsest = 0;                                    // geometry at the coarsest step
  double finest = 0;                                      // geometry at the finest useful step
  std::array<double, kMaxIntensityBits + 1> intensity{};  // by the number of bits

  double AtCoarsest(unsigned bits) const { return coarsest + intensity[bits]; }
  double AtFinest(unsigned bits) const { return finest + intensity[bits]; }
  Demand& operator+=(const Demand& o);
  Demand& operator*=(double factor);
};

class DemandTable {
 public:
  void Set(std::uint32_t slice_index, std::uint32_t slice_count, const Demand& demand);
  /// Sums over the slices from `first` to the end of the scan. Unknown slices count as the mean of
  /// the others.
  Demand Sum(std::uint32_t first = 0) const;
  /// Divides `surplus` bytes among the slices from `first` to the end of the scan. Each gets the
  /// same, up to the difference of its sizes at the coarsest and finest step. An unknown slice has
  /// no limit. Returns the share of a slice below its limit.
  double EvenShare(std::uint32_t first, double surplus) const;

 private:
  std::vector<std::optional<Demand>> slices_;
  std::size_t seen_ = 0;
};

}  // namespace lidar::rate
