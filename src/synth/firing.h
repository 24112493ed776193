// SPDX-License-Identifier: LGPL-2.1-or-later
// Sensors of other makers as tables of laser directions and firing times.
#pragma once
#include <cstdint>
#include <string_view>

namespace lidar::synth {

/// The layout of the maker's ROS driver: one row of returns, in the order of firing.
struct DriverLayout {
  std::string_view fields;  // as in caps of clouds
  double timestamp_unit_s;  // of the field `timestamp`
};

/// Lasers fire one after the other in columns, at a constant column rate. Angles are degrees;
/// azimuths are clockwise from x.
struct Firing {
  std::string_view name;
  std::uint32_t lasers;
  std::uint32_t banks;     // laser i, in the order of firing, is ring i / banks of bank i % banks
  double first_elevation;  // of ring 0
  double elevation_step;   // from one ring to the next
  double bank_azimuth;     // from one bank to the next
  double laser_delay_ns;   // from one laser to the next
  std::uint32_t columns;   // of a scan
  double first_azimuth, view;  // where a sweep begins, and its span
  double sweeps;               // per scan; scans differ if this is not a whole number
  double swing, swings;        // amplitude and number per scan of the elevations' swings
  double fan;                  // from one laser to the next, in a plane that does not turn
  double azimuth_unit;         // of the reported azimuths; 0: exact
  std::uint32_t range_unit_mm;
  double min_range_m, max_range_m, range_of_10_percent_m;
  DriverLayout layout;

  static constexpr int kScansPerSecond = 10;

  std::uint32_t RingOf(std::uint32_t laser) const {
    return laser % banks * (lasers / banks) + laser / banks;
  }
  double ElevationOf(std::uint32_t laser) const {
    return first_elevation + elevation_step * RingOf(laser);
  }
};

/// "vlp-16", "xt32", "at128" or "mid-360"; null for any other.
const Firing* FindFiring(std::string_view name);

}  // namespace lidar::synth
