// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes clouds like those that the ROS driver of a sensor publishes. They have a single row of
// points, in the order of firing.
#pragma once
#include <optional>
#include <vector>

#include "gst/lidar/cloud_info.h"
#include "src/synth/scanner.h"

namespace lidar::gst {

/// Must be used by the streaming thread only.
class DriverCloud {
 public:
  explicit DriverCloud(const synth::Firing& firing);

  /// Returns the caps of the clouds, without a width, because each cloud has a different width.
  static CloudInfo InfoFor(const synth::Firing& firing);

  struct Sweep {
    std::uint64_t scan;
    ColumnWindow window;
    GstClockTime begin;  // time of the first column, since 1970
    Duration column;     // time from one column to the next
  };
  /// Writes a point for each return. The result is valid until the next call.
  const std::vector<std::uint8_t>& Write(const synth::Returns& returns, const synth::Rays& rays,
                                         const Sweep& sweep);
  /// Returns the caps of the cloud that was written last. The width is 0 if the cloud has no
  /// returns.
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
  /// The offsets of fields that drivers add to x, y, z and intensity. Empty if the cloud does not
  /// have the field.
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
