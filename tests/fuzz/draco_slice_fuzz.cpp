// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes slices as dracodec receives them: range header, mask, integers, and streams of Draco. The
// first byte of the input chooses the geometry and the sensor.
#include <vector>

#include "ext/draco/slice_coder.h"
#include "src/codec/slice_links.h"
#include "tests/fuzz/fuzz.h"

namespace {

using lidar::Geometry;
using lidar::draco::SliceDecoder;

constexpr std::uint32_t kMaxPoints = 1U << 16;

/// Returns a sensor model. The coder splits rows of 512 columns into lanes, but not rows of 64
/// columns.
lidar::SensorModel Sensor(std::uint32_t beams, std::uint32_t columns) {
  lidar::SensorModel model;
  model.columns_per_scan = columns;
  for (std::uint32_t i = 0; i < beams; ++i)
    model.beams.push_back({0.5, 10.0 - i, static_cast<int>(i % 3)});
  return model;
}

lidar::codec::CloudFormat Format(std::uint8_t choice) {
  lidar::codec::CloudFormat format;
  format.layout.fields = *lidar::PointFields::Parse(
      (choice & 1) != 0 ? "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16"
                        : "x:F32:0,y:F32:4,z:F32:8");
  format.layout.point_step = format.layout.fields.MinimumStep();
  format.height = (choice & 4) != 0 ? 16 : 4;
  format.sensor_model = Sensor(format.height, (choice & 8) != 0 ? 512 : 64);
  return format;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto format = Format(data[0]);
  const Geometry geometry = (data[0] & 2) != 0 ? Geometry::kRange : Geometry::kXyz;
  SliceDecoder decoder(format, geometry, kMaxPoints);
  // Decodes the slice twice, because the first decoding must not change the state that the second
  // one uses.
  for (int i = 0; i < 2; ++i) {
    const auto shape = decoder.Decode({data + 1, size - 1});
    if (!shape) continue;
    if (geometry == Geometry::kRange) {
      FUZZ_CHECK(lidar::codec::LinksOf({data + 1, size - 1}).has_value());
    }
    const std::size_t points = std::size_t{shape->width} * shape->height;
    FUZZ_CHECK(points > 0 && points <= kMaxPoints);
    std::vector<std::uint8_t> raw(points * format.layout.point_step);
    decoder.Write(raw.data());
  }
  return 0;
}
