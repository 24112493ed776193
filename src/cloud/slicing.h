// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes into how many slices a source divides a scan.
#pragma once
#include <cstdint>

#include "src/base/time.h"

namespace lidar {

struct ScanShape {
  std::uint32_t columns = 0;  // columns of a full turn
  std::uint32_t beams = 0;
  Duration period{};  // duration of a turn
};

/// Returns the largest divisor of `columns` that is at most `slices`, but at least 1.
constexpr std::uint32_t SlicesDividing(std::uint32_t columns, std::uint32_t slices) {
  for (; slices > 1; --slices)
    if (columns % slices == 0) return slices;
  return 1;
}

/// Returns the automatic number of slices. A slice takes about 12.5 ms, or longer if it would
/// otherwise have too few points to compress well.
constexpr std::uint32_t AutomaticSlices(const ScanShape& scan) {
  constexpr Duration kSweep{12'500'000};
  constexpr std::uint64_t kPointsPerSlice = 2000;
  const auto by_time = static_cast<std::uint64_t>((scan.period + kSweep / 2) / kSweep);
  const std::uint64_t by_points = std::uint64_t{scan.columns} * scan.beams / kPointsPerSlice;
  const std::uint64_t wanted = by_time < by_points ? by_time : by_points;
  return SlicesDividing(scan.columns,
                        wanted < scan.columns ? static_cast<std::uint32_t>(wanted) : scan.columns);
}

/// Returns the number of slices for a value of the property `slices-per-scan`. The value 0 means
/// automatic. Other values are rounded down to a divisor of the number of columns.
constexpr std::uint32_t SlicesPerScan(std::uint32_t requested, const ScanShape& scan) {
  if (requested == 0) return AutomaticSlices(scan);
  return SlicesDividing(scan.columns, requested < scan.columns ? requested : scan.columns);
}

}  // namespace lidar
