// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/enc_range_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/codec/point_math.h"

namespace lidar::gst {
namespace {

constexpr double kFloatRounding = 1e-5;  // of the range
constexpr std::size_t kLookAhead = 256;  // points, for a return

}  // namespace

std::optional<RangeCheck> RangeCheck::Create(const codec::CloudFormat& format) {
  if (!format.sensor_model || !format.layout.fields.HasPackedXyz()) return std::nullopt;
  return RangeCheck(format);
}

RangeCheck::RangeCheck(const codec::CloudFormat& format)
    : layout_(format.layout),
      unit_mm_(format.sensor_model->range_unit_mm),
      projection_(*format.sensor_model) {}

std::optional<RangeCheck::Contradiction> RangeCheck::Find(ByteView raw,
                                                          std::uint32_t first_column) const {
  const std::size_t points = raw.size / layout_.point_step;
  const std::size_t columns = points / projection_.beams();
  const std::uint8_t* ranges = raw.data + layout_.fields.Find("range")->offset;
  for (std::size_t k = 0; k < kSamples; ++k) {
    std::size_t i = points * (2 * k + 1) / (2 * kSamples);
    const std::size_t end = std::min(points, i + kLookAhead);
    while (i < end && codec::RangeAt(ranges + i * layout_.point_step) == 0) ++i;
    if (i == end) continue;
    const std::uint32_t range_mm = codec::RangeAt(ranges + i * layout_.point_step);
    const auto beam = static_cast<std::uint32_t>(i / columns);
    const auto column =
        static_cast<std::uint32_t>((first_column + i % columns) % projection_.columns());
    float found[3];
    std::memcpy(found, raw.data + i * layout_.point_step + layout_.fields.Find("x")->offset,
                sizeof found);
    const auto expected = projection_.Point(beam, column, range_mm);
    const double distance = std::hypot(static_cast<double>(found[0] - expected[0]),
                                       static_cast<double>(found[1] - expected[1]),
                                       static_cast<double>(found[2] - expected[2]));
    // Written so that NaN is a contradiction, too.
    if (!(distance <= 1e-3 * unit_mm_ + kFloatRounding * 1e-3 * range_mm))
      return Contradiction{beam, column, distance};
  }
  return std::nullopt;
}

}  // namespace lidar::gst
