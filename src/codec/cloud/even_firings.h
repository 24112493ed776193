// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the firings of points in the order of firing.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/codec/cloud/beam_keeper.h"
#include "src/codec/cloud/beam_table.h"
#include "src/codec/cloud/wave_fit.h"

namespace lidar::codec::cloud {

constexpr std::uint32_t kMostLines = 16;

/// Firings at even steps of the azimuth.
struct EvenFirings {
  double first = 0;  // azimuth of firing 0
  double step = 0;
  std::uint32_t count = 0;
  std::vector<Sample> samples;  // one a point
};

/// Returns nothing if azimuths are not at even steps.
std::optional<EvenFirings> FindFirings(const std::vector<Sighting>& points);

}  // namespace lidar::codec::cloud
