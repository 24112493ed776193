// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/range_check.h"

#include <algorithm>
#include <cmath>

#include "src/cloud/point_math.h"

namespace lidar {
namespace {

constexpr double kFloatRounding = 1e-5;  // as a fraction of the range
constexpr std::size_t kLookAhead = 256;  // number of points to search for a return

}  // namespace

std::optional<RangeCheck> RangeCheck::Create(const PointFields& fields, std::uint32_t point_step,
                                             const SensorModel& model) {
  if (!fields.HasPackedXyz() || !fields.Has("range", FieldType::kU32)) return std::nullopt;
  return RangeCheck(fields, point_step, model);
}

RangeCheck::RangeCheck(const PointFields& fields, std::uint32_t point_step,
                       const SensorModel& model)
    : range_offset_(fields.Find("range")->offset),
      xyz_offset_(fields.Find("x")->offset),
      point_step_(point_step),
      unit_mm_(model.range_unit_mm),
      projection_(model) {}

std::optional<RangeCheck::Contradiction> RangeCheck::Find(ByteView raw,
                                                          std::uint32_t first_column) const {
  if (raw.size == 0) return std::nullopt;
  const std::size_t points = raw.size / point_step_;
  const std::size_t columns = points / projection_.beams();
  const std::uint8_t* ranges = raw.data + range_offset_;
  for (std::size_t k = 0; k < kSamples; ++k) {
    std::size_t i = points * (2 * k + 1) / (2 * kSamples);
    const std::size_t end = std::min(points, i + kLookAhead);
    while (i < end && RangeAt(ranges + i * point_step_) == 0) ++i;
    if (i == end) continue;
    const std::uint32_t range_mm = RangeAt(ranges + i * point_step_);
    const auto beam = static_cast<std::uint32_t>(i / columns);
    const auto column =
        static_cast<std::uint32_t>((first_column + i % columns) % projection_.columns());
    const auto found = PositionAt(raw.data + i * point_step_ + xyz_offset_);
    const auto expected = projection_.Point(beam, column, range_mm);
    // hypot() with three arguments is not used, because in libstdc++ it returns 0 if two arguments
    // are 0 and the third is NaN.
    const double across = std::hypot(static_cast<double>(found[0] - expected[0]),
                                     static_cast<double>(found[1] - expected[1]));
    const double distance = std::hypot(across, static_cast<double>(found[2] - expected[2]));
    // The condition is negated, so that NaN counts as a contradiction, too.
    if (!(distance <= 1e-3 * unit_mm_ + kFloatRounding * 1e-3 * range_mm))
      return Contradiction{beam, column, distance};
  }
  return std::nullopt;
}

}  // namespace lidar
