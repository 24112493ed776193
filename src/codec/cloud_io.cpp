// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud_io.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

namespace lidar::codec {
namespace {

template <class T>
T Load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

template <class T>
void Store(T value, std::uint8_t* bytes) {
  std::memcpy(bytes, &value, sizeof value);
}

/// Returns the field, or null if it is missing or of another type. The type must be checked because
/// caps may come from a network.
const PointField* FindTyped(const PointFields& fields, const char* name, FieldType type) {
  return fields.Has(name, type) ? fields.Find(name) : nullptr;
}

/// Returns true if all ranges are multiples of `unit_mm`.
bool AreMultiples(const std::vector<std::uint32_t>& ranges, std::uint32_t unit_mm) {
  if (unit_mm == 1) return true;
  std::uint32_t remainders = 0;
  if ((unit_mm & (unit_mm - 1)) == 0) {
    for (const std::uint32_t r : ranges) remainders |= r;
    return (remainders & (unit_mm - 1)) == 0;
  }
  for (const std::uint32_t r : ranges) remainders |= r % unit_mm;
  return remainders == 0;
}

}  // namespace

bool CloudFormat::HasRanges() const {
  return sensor_model && sensor_model->beams.size() == height &&
         layout.fields.Has("range", FieldType::kU32);
}

PointFields KeptFields(const PointFields& input, bool with_intensity, bool with_range) {
  PointFields kept;
  kept.Add("x", FieldType::kF32).Add("y", FieldType::kF32).Add("z", FieldType::kF32);
  if (with_intensity && HasIntensity(input)) kept.Add("intensity", FieldType::kF32);
  if (with_range) kept.Add("range", FieldType::kU32);
  return kept;
}

std::vector<PointField> ExactFields(const PointFields& kept) {
  const PointFields usual = KeptFields(kept, true, false);
  std::vector<PointField> exact;
  for (const PointField& field : kept.all())
    if (usual.Find(field.name) == nullptr) exact.push_back(field);
  return exact;
}

bool HasIntensity(const PointFields& fields) { return fields.Has("intensity", FieldType::kF32); }

FullScale ReadRangeImage(ByteView raw, const CloudLayout& layout, bool with_intensity,
                         RangeImage* image) {
  const std::size_t count = image->size();
  image->ranges.resize(count);
  image->intensity.clear();
  if (count == 0) return FullScale::kByte;
  const std::uint8_t* point = raw.data + layout.fields.Find("range")->offset;
  for (std::size_t i = 0; i < count; ++i, point += layout.point_step)
    image->ranges[i] = Load<std::uint32_t>(point);
  if (!with_intensity || !HasIntensity(layout.fields)) return FullScale::kByte;
  // A driver may leave any number as the intensity of a missing return. This number must not
  // determine the scale, so it is replaced by 0.
  const std::uint8_t* first = raw.data + layout.fields.Find("intensity")->offset;
  const auto intensity_of = [&](std::size_t i) {
    const auto value = Load<float>(first + i * layout.point_step);
    return image->ranges[i] != 0 && std::isfinite(value) ? value : 0.0F;
  };
  float largest = 0;
  for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, intensity_of(i));
  const IntensityScale scale(IntensityScale::Fitting(largest), kFineIntensityBits);
  image->intensity.resize(count);
  for (std::size_t i = 0; i < count; ++i) image->intensity[i] = scale.LevelOf(intensity_of(i));
  return scale.full();
}

std::uint32_t CommonUnit(const std::vector<std::uint32_t>& ranges, std::uint32_t sensor_unit_mm) {
  // The divisor of this many returns is nearly always the divisor of all returns.
  constexpr unsigned kSample = 64;
  std::uint32_t unit = 0;
  unsigned seen = 0;
  for (auto r = ranges.begin(); r != ranges.end() && unit != 1 && seen < kSample; ++r) {
    unit = std::gcd(unit, *r);
    if (*r != 0) ++seen;
  }
  if (unit == 0) return sensor_unit_mm;
  if (!AreMultiples(ranges, unit))
    for (const std::uint32_t r : ranges) unit = std::gcd(unit, r);
  return unit <= RangeGrid::kMaxUnitMm ? unit : std::gcd(unit, sensor_unit_mm);
}

void ReadXyz(ByteView raw, const CloudLayout& layout, bool with_intensity, XyzCloud* cloud,
             std::vector<std::uint32_t>* rows) {
  cloud->intensity.clear();
  if (rows != nullptr) rows->clear();
  const std::size_t count = raw.size / layout.point_step;
  const std::uint32_t xyz_offset = layout.fields.Find("x")->offset;
  const PointField* intensity = with_intensity ? layout.fields.Find("intensity") : nullptr;
  cloud->xyz.resize(3 * count);  // writes no zeros if the last cloud had as many points
  float* next = cloud->xyz.data();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* point = raw.data + i * layout.point_step;
    float p[3];
    std::memcpy(p, point + xyz_offset, sizeof p);
    const bool missing = p[0] == 0 && p[1] == 0 && p[2] == 0;
    if (missing || !std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) continue;
    for (const float v : p) *next++ = v;
    if (rows != nullptr) rows->push_back(static_cast<std::uint32_t>(i));
    if (intensity == nullptr) continue;
    const auto value = Load<float>(point + intensity->offset);
    cloud->intensity.push_back(std::isfinite(value) && value > 0 ? value : 0.0F);
  }
  cloud->xyz.resize(static_cast<std::size_t>(next - cloud->xyz.data()));
}

void WriteRangeImage(const RangeImage& image, const IntensityScale& scale,
                     const RangeProjection& projection, const CloudLayout& layout,
                     std::uint8_t* raw) {
  const PointField* range = FindTyped(layout.fields, "range", FieldType::kU32);
  const PointField* intensity =
      image.intensity.empty() ? nullptr : FindTyped(layout.fields, "intensity", FieldType::kF32);
  // If the layout has only these fields, every byte of `raw` is written below, so no zeros are
  // needed.
  const PointFields kept = KeptFields(layout.fields, intensity != nullptr, range != nullptr);
  if (kept != layout.fields || layout.point_step != kept.MinimumStep())
    std::memset(raw, 0, image.size() * layout.point_step);
  std::array<float, 256> values{};
  for (unsigned level = 0; intensity != nullptr && level < values.size(); ++level)
    values[level] = scale.ValueOf(static_cast<std::uint8_t>(level));
  const std::uint32_t xyz = layout.fields.Find("x")->offset;
  const bool range_is_behind = range != nullptr && range->offset == xyz + 3 * sizeof(float);
  for (std::uint32_t beam = 0; beam < image.beams; ++beam) {
    const std::size_t first = std::size_t{beam} * image.columns;
    const std::uint32_t* ranges = &image.ranges[first];
    projection.ProjectBeam(beam, ranges, {image.first_column, image.columns},
                           range_is_behind ? ranges : nullptr, raw + xyz, layout.point_step);
    std::uint8_t* point = raw;
    for (std::uint32_t i = 0; range != nullptr && !range_is_behind && i < image.columns; ++i) {
      Store(ranges[i], point + range->offset);
      point += layout.point_step;
    }
    point = raw;
    for (std::uint32_t i = 0; intensity != nullptr && i < image.columns; ++i) {
      Store(ranges[i] == 0 ? 0.0F : values[image.intensity[first + i]], point + intensity->offset);
      point += layout.point_step;
    }
    raw += image.columns * layout.point_step;
  }
}

void WriteXyz(const XyzCloud& cloud, const CloudLayout& layout, std::uint8_t* raw,
              const std::vector<std::uint32_t>& order) {
  const std::uint32_t xyz_offset = layout.fields.Find("x")->offset;
  const PointField* intensity = FindTyped(layout.fields, "intensity", FieldType::kF32);
  const bool has_intensity = intensity != nullptr && cloud.intensity.size() == cloud.size();
  std::memset(raw, 0, cloud.size() * layout.point_step);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::uint8_t* point = raw + (order.empty() ? i : order[i]) * layout.point_step;
    std::memcpy(point + xyz_offset, &cloud.xyz[3 * i], 3 * sizeof(float));
    if (has_intensity) Store(cloud.intensity[i], point + intensity->offset);
  }
}

}  // namespace lidar::codec
