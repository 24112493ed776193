// SPDX-License-Identifier: LGPL-2.1-or-later
// The bytes that each slice of the current scan needs at least, and can use at most.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace lidar::rate {

constexpr unsigned kMaxIntensityBits = 16;

/// The predicted bytes of a slice, or of several slices.
struct Demand {
  double coarsest = 0;                                    // geometry at the coarsest step
  double finest = 0;                                      // geometry at the finest useful step
  std::array<double, kMaxIntensityBits + 1> intensity{};  // index: number of bits

  double AtCoarsest(unsigned bits) const { return coarsest + intensity[bits]; }
  double AtFinest(unsigned bits) const { return finest + intensity[bits]; }
  Demand& operator+=(const Demand& o);
  Demand& operator*=(double factor);
};

class DemandTable {
 public:
  void Set(std::uint32_t slice_index, std::uint32_t slice_count, const Demand& demand);
  /// Returns the sum over the slices from `first` to the end of the scan. A slice whose demand is
  /// unknown counts as the mean of the others.
  Demand Sum(std::uint32_t first = 0) const;
  /// Divides `surplus` bytes among the slices from `first` to the end of the scan. All slices get
  /// the same number of bytes, but none gets more than its limit: the difference of its sizes at
  /// the finest and the coarsest step. A slice whose demand is unknown has no limit. Returns the
  /// number of bytes for a slice that is below its limit.
  double EvenShare(std::uint32_t first, double surplus) const;

 private:
  std::vector<std::optional<Demand>> slices_;
  std::size_t seen_ = 0;
};

}  // namespace lidar::rate
