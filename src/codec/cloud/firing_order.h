// SPDX-License-Identifier: LGPL-2.1-or-later
// The order in which a sensor fires. The points of one firing have similar fields.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lidar::codec::cloud {

/// The pixel from which a decoded point comes.
struct PointPlace {
  static constexpr std::uint32_t kNoBeam = UINT32_MAX;
  std::uint32_t beam = kNoBeam;  // kNoBeam: a point of a cell, or a far point
  std::uint32_t column = 0;

  bool is_loose() const { return beam == kNoBeam; }
};

/// The places of all points of a slice, in the order in which a decoder returns the points.
struct PointPlaces {
  std::uint32_t beams = 0;    // 0: all points are loose
  std::uint32_t columns = 0;  // columns in a turn; larger than the column of any point
  std::vector<PointPlace> points;

  void AddLoose(std::size_t count) { points.resize(points.size() + count); }
};

struct FiringOrder {
  /// When a beam fires.
  struct Slot {
    std::uint32_t delay = 0;  // firing minus column, modulo the number of columns
    std::uint32_t rank = 0;   // position of the beam within a firing
  };
  std::uint32_t first = 0;  // the first firing
  bool descends = false;    // columns decrease with time
  std::vector<Slot> slots;  // one for each beam

  /// Returns how many firings after `first` a point was measured. The point must not be loose.
  std::uint32_t FiringOf(const PointPlace& place, std::uint32_t columns) const {
    const std::uint32_t firing = (place.column + slots[place.beam].delay) % columns;
    return (descends ? first + columns - firing : firing + columns - first) % columns;
  }
  /// Returns the indices of all points: first the points of beams, in the order of their firings,
  /// then the loose points.
  std::vector<std::uint32_t> Visit(const PointPlaces& places) const;
};

/// Finds the order of firings. `clock` has a number for each point, which rises with the time of
/// the point. Sets `fit` to the part of the points that agree with the order.
FiringOrder FindFiringOrder(const PointPlaces& places, const std::vector<std::int64_t>& clock,
                            double* fit);

}  // namespace lidar::codec::cloud
