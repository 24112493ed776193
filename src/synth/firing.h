// SPDX-License-Identifier: LGPL-2.1-or-later
// Describes sensors of other makers by tables of laser directions and firing times.
#pragma once
#include <cstdint>
#include <string_view>

namespace lidar::synth {

/// The layout of a cloud from the maker's ROS driver. The cloud is one row of returns, in the order
/// of firing.
struct DriverLayout {
  std::string_view fields;  // as in the caps of clouds
  double timestamp_unit_s;  // unit of the field with the time of a point
};

/// A table of a sensor whose lasers fire one after the other in columns, at a constant column rate.
/// Angles are in degrees. Azimuths are clockwise from x.
struct Firing {
  std::string_view name;
  std::uint32_t lasers;
  std::uint32_t banks;     // laser i, in the order of firing, is ring i / banks of bank i % banks
  double first_elevation;  // elevation of ring 0
  double elevation_step;   // difference in elevation from one ring to the next
  double bank_azimuth;     // difference in azimuth from one bank to the next
  double laser_delay_ns;   // time from one laser to the next
  std::uint32_t columns;   // columns per scan
  double first_azimuth, view;  // azimuth at which a sweep begins, and span of a sweep
  double sweeps;               // sweeps per scan; scans differ if this is not a whole number
  double swing, swings;        // the elevations swing with this amplitude, this many times per scan
  double fan;                  // angle from one laser to the next, in a plane that does not rotate
  double azimuth_unit;         // unit of the reported azimuths; 0: exact
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

/// Returns the table of "vlp-16", "xt32", "at128" or "mid-360", or null for another name.
const Firing* FindFiring(std::string_view name);

}  // namespace lidar::synth
