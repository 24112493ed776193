// SPDX-License-Identifier: LGPL-2.1-or-later
// The order in which a sensor fires. Points of a firing have similar fields.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lidar::codec::cloud {

/// The pixel that a decoded point comes from.
struct PointPlace {
  static constexpr std::uint32_t kNoBeam = UINT32_MAX;
  std::uint32_t beam = kNoBeam;  // kNoBeam: from cells, or far away
  std::uint32_t column = 0;

  bool is_loose() const { return beam == kNoBeam; }
};

/// The places of all points of a slice, as decoders give them.
struct PointPlaces {
  std::uint32_t beams = 0;    // 0: all points are loose
  std::uint32_t columns = 0;  // of a turn; more than the column of any point
  std::vector<PointPlace> points;

  void AddLoose(std::size_t count) { points.resize(points.size() + count); }
};

struct FiringOrder {
  /// Time of a beam within the firings.
  struct Slot {
    std::uint32_t delay = 0;  // from a column of the beam to its firing; below columns
    std::uint32_t rank = 0;   // place in a firing
  };
  std::uint32_t first = 0;  // the first firing
  bool descends = false;    // columns fall with time
  std::vector<Slot> slots;  // of the beams

  /// Returns the number of firings from the first one to that of a point, which must not be loose.
  std::uint32_t FiringOf(const PointPlace& place, std::uint32_t columns) const {
    const std::uint32_t firing = (place.column + slots[place.beam].delay) % columns;
    return (descends ? first + columns - firing : firing + columns - first) % columns;
  }
  /// Returns the points of beams in the order of their firings, then the loose ones.
  std::vector<std::uint32_t> Visit(const PointPlaces& places) const;
};

/// Finds the order by `clock`, which rises with the time of each point. Sets `fit` to the part of
/// the points that agree with it.
FiringOrder FindFiringOrder(const PointPlaces& places, const std::vector<std::int64_t>& clock,
                            double* fit);

}  // namespace lidar::codec::cloud
