// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/odometry/point_times.h"

#include <algorithm>
#include <limits>

#include "src/cloud/field_number.h"
#include "src/cloud/point_math.h"

namespace lidar::gst {
namespace {

// The least and the greatest time from the first to the last sample, relative to the duration of a
// sweep. Their quotient is less than 1000, the factor between two units, so at most one unit
// matches.
constexpr double kShortestPart = 0.01;
constexpr double kLongestPart = 4;

/// Returns the unit of the times, or 0 if no unit makes `span` about as long as a sweep.
double UnitFor(double span, double sweep_s) {
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9}) {
    const double part = span * unit / sweep_s;
    if (part >= kShortestPart && part <= kLongestPart) return unit;
  }
  return 0;
}

}  // namespace

const PointField* TimeFieldOf(const PointFields& fields) {
  for (const char* name : {"t", "time", "timestamp", "time_stamp", "offset_time"})
    if (const PointField* field = fields.Find(name)) return field;
  return nullptr;
}

std::vector<float> SecondsOf(const PointField& field, const PointsInMemory& points,
                             double sweep_s) {
  std::vector<double> times(points.count);
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  for (std::size_t i = 0; i < points.count; ++i) {
    const std::uint8_t* point = points.bytes + i * points.step;
    times[i] = ReadNumber(point + field.offset, field.type, false);
    // Missing returns are skipped, because they often have no valid time.
    if (!IsReturn(PositionAt(point + points.xyz_offset))) continue;
    first = std::min(first, times[i]);
    last = std::max(last, times[i]);
  }
  const double unit = UnitFor(last - first, sweep_s);
  if (!(unit > 0)) return {};
  std::vector<float> seconds(points.count);
  std::transform(times.begin(), times.end(), seconds.begin(), [&](double time) {
    // The time of a missing return is limited, because it may be any number.
    return time > first ? static_cast<float>((std::min(time, last) - first) * unit) : 0.0F;
  });
  return seconds;
}

}  // namespace lidar::gst
