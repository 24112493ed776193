// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the raw clouds of buffers to the input of the codecs, and back.
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

/// Points without order. Either all of them have an intensity, or none.
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

/// The contents of a stream's caps, which apply to each raw slice.
struct CloudFormat {
  CloudLayout layout;
  std::uint32_t height = 1;  // beams, if the cloud is organised
  std::optional<SensorModel> sensor_model;

  /// Returns true if slices can be coded in range geometry.
  bool HasRanges() const;
};

constexpr unsigned kFineIntensityBits = IntensityScale::kMaxBits;

/// The fields of an encoded slice, packed: x, y, z, intensity if it is wanted and in `input`, and
/// range if it is wanted.
PointFields KeptFields(const PointFields& input, bool with_intensity, bool with_range);

/// The fields of `kept` other than x, y, z and intensity, which are decoded exactly.
std::vector<PointField> ExactFields(const PointFields& kept);

/// Returns true if there is an intensity of type F32, which the codecs need.
bool HasIntensity(const PointFields& fields);

/// Fills `image`, whose beams, columns and first_column are set, from the points of `raw`, one for
/// each pixel. Intensities, if they are wanted and present, become levels of kFineIntensityBits.
/// Returns the full scale of the levels.
FullScale ReadRangeImage(ByteView raw, const CloudLayout& layout, bool with_intensity,
                         RangeImage* image);
/// The common divisor of all ranges [mm]: coarser than the sensor's unit, or finer if the cloud was
/// filtered. If it is above RangeGrid::kMaxUnitMm, or if there are no returns, the result is the
/// largest divisor of the sensor's unit that divides all ranges.
std::uint32_t CommonUnit(const std::vector<std::uint32_t>& ranges, std::uint32_t sensor_unit_mm);

/// Fills `cloud` with the points of `raw` that are finite and not all zero. Intensities that are
/// negative or not finite become 0. `rows`, if not null, gets the index of each point in `raw`.
void ReadXyz(ByteView raw, const CloudLayout& layout, bool with_intensity, XyzCloud* cloud,
             std::vector<std::uint32_t>* rows = nullptr);

/// Writes the pixels of `image` as points, missing returns as zeros; `raw` has image.size() *
/// point_step bytes.
void WriteRangeImage(const RangeImage& image, const IntensityScale& scale,
                     const RangeProjection& projection, const CloudLayout& layout,
                     std::uint8_t* raw);
/// Writes `cloud` as points, point i at place order[i], or i if `order` is empty. Other fields are
/// zero.
void WriteXyz(const XyzCloud& cloud, const CloudLayout& layout, std::uint8_t* raw,
              const std::vector<std::uint32_t>& order = {});

}  // namespace lidar::codec
