// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds as the ROS driver of a sensor publishes them: a row in the order of firing.
#pragma once
#include <optional>
#include <vector>

#include "gst/lidar/cloud_info.h"
#include "src/synth/scanner.h"

namespace lidar::gst {

/// Used by the streaming thread.
class DriverCloud {
 public:
  explicit DriverCloud(const synth::Firing& firing);

  /// Caps of such clouds. They do not fix the width, because each cloud has its own.
  static CloudInfo InfoFor(const synth::Firing& firing);

  struct Sweep {
    std::uint64_t scan;
    ColumnWindow window;
    GstClockTime begin;  // of its first column, since 1970
    Duration column;     // from one to the next
  };
  /// Writes the points of the returns.
  const std::vector<std::uint8_t>& Write(const synth::Returns& returns, const synth::Rays& rays,
                                         const Sweep& sweep);
  /// Caps of the last written cloud. The width is 0 if it has no returns.
  const CloudInfo& info() const { return info_; }

 private:
  using Vec3 = synth::Vec3;
  struct Shot {
    std::uint32_t laser;
    std::uint32_t range_mm;
    float intensity;
    Vec3 direction;
    double since_begin_ns;
  };
  /// Offsets of the fields that drivers add to x, y, z and intensity.
  struct Offsets {
    std::optional<std::uint32_t> ring, line, time, timestamp;
  };
  void WritePoint(const Shot& shot, GstClockTime begin, std::uint8_t* point) const;

  const synth::Firing& firing_;
  CloudInfo info_;
  Offsets at_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace lidar::gst
