// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the raw clouds in buffers to the input of the codecs, and back.
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

/// Points without order. Either all of them have an intensity, or none has.
struct XyzCloud {
  std::vector<float> xyz;  // [m], three per point
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

/// The format of the raw slices of a stream, as its caps describe it.
struct CloudFormat {
  CloudLayout layout;
  std::uint32_t height = 1;  // beams, if the cloud is organised
  std::optional<SensorModel> sensor_model;

  /// Returns true if slices can be coded in range geometry.
  bool HasRanges() const;
};

constexpr unsigned kFineIntensityBits = IntensityScale::kMaxBits;

/// Returns the fields of a slice after decoding, packed. They are x, y and z. There is also the
/// intensity if `with_intensity` and `input` has it, and the range if `with_range`.
PointFields KeptFields(const PointFields& input, bool with_intensity, bool with_range);

/// Returns the fields of `kept` other than x, y, z and intensity. These fields are decoded exactly.
std::vector<PointField> ExactFields(const PointFields& kept);

/// Returns true if there is an intensity of type F32, which the codecs need.
bool HasIntensity(const PointFields& fields);

/// Fills the ranges of `image` from the points of `raw`. There is a point for each pixel. The
/// caller has set the beams, columns and first_column of `image`. If `with_intensity` and the
/// layout has intensities, these become levels of kFineIntensityBits. Returns the full scale of the
/// levels.
FullScale ReadRangeImage(ByteView raw, const CloudLayout& layout, bool with_intensity,
                         RangeImage* image);
/// Returns the greatest common divisor of all ranges [mm]. It may be a multiple of the sensor's
/// unit, or a smaller number if the cloud was filtered. If it is above RangeGrid::kMaxUnitMm, or if
/// there are no returns, returns the largest divisor of the sensor's unit that divides all ranges.
std::uint32_t CommonUnit(const std::vector<std::uint32_t>& ranges, std::uint32_t sensor_unit_mm);

/// Fills `cloud` with those points of `raw` whose coordinates are finite and not all 0. Intensities
/// that are negative or not finite become 0. If `rows` is not null, it gets the index that each
/// point of `cloud` has in `raw`.
void ReadXyz(ByteView raw, const CloudLayout& layout, bool with_intensity, XyzCloud* cloud,
             std::vector<std::uint32_t>* rows = nullptr);

/// Writes the pixels of `image` as points to `raw`, which has image.size() * point_step bytes. A
/// pixel without a return becomes a point with zeros.
void WriteRangeImage(const RangeImage& image, const IntensityScale& scale,
                     const RangeProjection& projection, const CloudLayout& layout,
                     std::uint8_t* raw);
/// Writes the points of `cloud` to `raw`. Point i is written at index order[i], or at index i if
/// `order` is empty. Fields that `cloud` does not have are set to zero.
void WriteXyz(const XyzCloud& cloud, const CloudLayout& layout, std::uint8_t* raw,
              const std::vector<std::uint32_t>& order = {});

}  // namespace lidar::codec
