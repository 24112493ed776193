// SPDX-License-Identifier: LGPL-2.1-or-later
// Raw clouds, as they lie in buffers, to and from what the codecs work on.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"
#include "src/cloud/range_grid.h"
#include "src/cloud/range_projection.h"
#include "src/codec/intensity_scale.h"
#include "src/codec/range_image.h"

namespace lidar::codec {

/// Points without order; intensities are as many, or none.
struct XyzCloud {
  std::vector<float> xyz;  // metres, three a point
  std::vector<float> intensity;

  std::size_t size() const { return xyz.size() / 3; }
  void Clear() {
    xyz.clear();
    intensity.clear();
  }
};

struct CloudLayout {
  PointFields fields;
  std::uint32_t point_step = 0;  // bytes

  bool operator==(const CloudLayout& o) const {
    return fields == o.fields && point_step == o.point_step;
  }
};

/// What the caps say of every raw slice of a stream.
struct CloudFormat {
  CloudLayout layout;
  std::uint32_t height = 1;  // beams, where the cloud is organised
  std::optional<SensorModel> sensor_model;

  /// Whether it can be coded in range geometry.
  bool HasRanges() const;
};

constexpr unsigned kFineIntensityBits = IntensityScale::kMaxBits;

/// The fields of `input` that an encoded slice keeps, packed: x, y, z, and where they are wanted
/// and there, intensity and range.
PointFields KeptFields(const PointFields& input, bool with_intensity, bool with_range);

/// The other fields of an encoded slice of points, which come back exactly.
std::vector<PointField> ExactFields(const PointFields& kept);

/// Returns true if there is an intensity that the codecs take: F32.
bool HasIntensity(const PointFields& fields);

/// Fills `image`, whose beams, columns and first_column are set, from `raw` of as many points.
/// Intensities, where they are wanted and there, become levels of kFineIntensityBits; the result
/// is what they are levels of.
FullScale ReadRangeImage(ByteView raw, const CloudLayout& layout, bool with_intensity,
                         RangeImage* image);
/// The common divisor of all ranges [mm]: coarser than the sensor's unit, or finer if the cloud was
/// filtered. Above RangeGrid::kMaxUnitMm, or without returns, it is the largest divisor of the
/// sensor's unit that divides all.
std::uint32_t CommonUnit(const std::vector<std::uint32_t>& ranges, std::uint32_t sensor_unit_mm);

/// Fills `cloud` with the points of `raw` that are finite and not all zero. Intensities that are
/// negative or not finite become 0. `rows`, if it is there, becomes the place of each in `raw`.
void ReadXyz(ByteView raw, const CloudLayout& layout, bool with_intensity, XyzCloud* cloud,
             std::vector<std::uint32_t>* rows = nullptr);

/// Writes `image` as points, missing ones as zeros; `raw` has image.size() * point_step bytes.
void WriteRangeImage(const RangeImage& image, const IntensityScale& scale,
                     const RangeProjection& projection, const CloudLayout& layout,
                     std::uint8_t* raw);
/// Writes `cloud` as points, each at its place of `order` if that is not empty; other fields are
/// zero.
void WriteXyz(const XyzCloud& cloud, const CloudLayout& layout, std::uint8_t* raw,
              const std::vector<std::uint32_t>& order = {});

}  // namespace lidar::codec
