// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/testsrc/driver_cloud.h"

#include <cstring>

namespace lidar::gst {
namespace {

constexpr std::size_t kIntensityAt = 12;

template <class T>
void Store(T value, std::uint8_t* at) {
  std::memcpy(at, &value, sizeof value);
}

std::optional<std::uint32_t> OffsetOf(const PointFields& fields, std::string_view name) {
  const PointField* field = fields.Find(name);
  if (field == nullptr) return std::nullopt;
  return field->offset;
}

}  // namespace

DriverCloud::DriverCloud(const synth::Firing& firing) : firing_(firing), info_(InfoFor(firing)) {
  at_ = {OffsetOf(info_.fields, "ring"), OffsetOf(info_.fields, "line"),
         OffsetOf(info_.fields, "time"), OffsetOf(info_.fields, "timestamp")};
}

CloudInfo DriverCloud::InfoFor(const synth::Firing& firing) {
  CloudInfo info;
  info.fields = *PointFields::Parse(firing.layout.fields);
  info.point_step = info.fields.MinimumStep();
  info.is_dense = true;
  info.framerate_n = synth::Firing::kScansPerSecond;
  return info;
}

void DriverCloud::WritePoint(const Shot& shot, GstClockTime begin, std::uint8_t* point) const {
  const float range = 1e-3F * static_cast<float>(shot.range_mm);
  const Vec3 p = range * shot.direction;
  Store(p.x, point);
  Store(p.y, point + 4);
  Store(p.z, point + 8);
  Store(shot.intensity, point + kIntensityAt);
  const std::uint32_t ring = firing_.RingOf(shot.laser);
  if (at_.ring) Store(static_cast<std::uint16_t>(ring), point + *at_.ring);
  if (at_.line) Store(static_cast<std::uint8_t>(ring), point + *at_.line);
  if (at_.time) Store(static_cast<float>(1e-9 * shot.since_begin_ns), point + *at_.time);
  if (at_.timestamp)
    Store(
        (static_cast<double>(begin) + shot.since_begin_ns) * 1e-9 / firing_.layout.timestamp_unit_s,
        point + *at_.timestamp);
}

const std::vector<std::uint8_t>& DriverCloud::Write(const synth::Returns& returns,
                                                    const synth::Rays& rays, const Sweep& sweep) {
  bytes_.clear();
  const std::uint32_t unit = firing_.range_unit_mm;
  for (std::uint32_t i = 0; i < sweep.window.count; ++i) {
    for (std::uint32_t laser = 0; laser < firing_.lasers; ++laser) {
      const std::size_t pixel = std::size_t{laser} * sweep.window.count + i;
      const std::uint32_t range = (returns.range_mm[pixel] + unit / 2) / unit * unit;
      if (range == 0) continue;
      bytes_.resize(bytes_.size() + info_.point_step);
      const double since =
          static_cast<double>(sweep.column.count()) * i + laser * firing_.laser_delay_ns;
      WritePoint({laser, range, static_cast<float>(returns.reflectivity[pixel]),
                  rays.Direction(sweep.scan, laser, sweep.window.first + i), since},
                 sweep.begin, bytes_.data() + bytes_.size() - info_.point_step);
    }
  }
  info_.width = static_cast<guint>(bytes_.size() / info_.point_step);
  return bytes_;
}

}  // namespace lidar::gst
