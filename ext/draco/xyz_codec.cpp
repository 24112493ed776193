// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/xyz_codec.h"

#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <optional>
#include <stdexcept>

#include "ext/draco/draco_check.h"
#include "src/cloud/xyz_grid.h"

namespace lidar::draco {
namespace {

using ::draco::GeometryAttribute;

constexpr int kMaxBits = 30;
// Draco's sequential coder sorts symbols with a table of 2^bits entries.
constexpr int kMaxSequentialBits = 18;
// The relative rounding error of a float.
constexpr double kRounding = 1.0 / (1 << 24);

struct Box {
  std::array<float, 3> low;
  double extent = 0;    // length of the longest side
  double farthest = 0;  // largest absolute value of a coordinate
};

Box BoxOf(const XyzCloud& cloud) {
  Box box{};
  std::array<float, 3> high{};
  std::copy_n(cloud.xyz.begin(), 3, box.low.begin());
  std::copy_n(cloud.xyz.begin(), 3, high.begin());
  for (std::size_t i = 3; i + 2 < cloud.xyz.size(); i += 3) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], cloud.xyz[i + axis]);
      high[axis] = std::max(high[axis], cloud.xyz[i + axis]);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto low = static_cast<double>(box.low[axis]);
    const auto top = static_cast<double>(high[axis]);
    box.extent = std::max(box.extent, top - low);
    box.farthest = std::max({box.farthest, std::abs(low), std::abs(top)});
  }
  return box;
}

struct Grid {
  double step_m;
  double error_m;
  int bits;
};

/// Returns a bound for the rounding errors of Draco [m], which computes in floats. The encoder
/// rounds the offset from the corner of the box, and the offset divided by the step. The decoder
/// rounds both again.
double RoundingOf(const Box& box) { return kRounding * (8 * box.extent + 2 * box.farthest); }

/// Returns the coarsest grid that the settings allow, or nothing if there is none.
std::optional<Grid> GridOf(const Box& box, const XyzSettings& settings) {
  const double rounding = RoundingOf(box);
  double step = settings.max_error_m / kXyzErrorPerStep - 2 * rounding;
  if (!(step > 0)) return std::nullopt;
  if (settings.step_m > 0) step = std::min(step, settings.step_m);
  const double cells = box.extent / step + 1;
  if (!(cells <= static_cast<double>(1U << kMaxBits) - 1)) return std::nullopt;
  const int bits = std::max(1, static_cast<int>(std::ceil(std::log2(cells + 1))));
  return Grid{step, (step + 2 * rounding) * kXyzErrorPerStep, std::min(bits, kMaxBits)};
}

void AddAttribute(GeometryAttribute::Type type, std::int8_t components,
                  const std::vector<float>& values, ::draco::PointCloud* cloud) {
  const auto stride = static_cast<std::int64_t>(sizeof(float)) * components;
  GeometryAttribute attribute;
  attribute.Init(type, nullptr, static_cast<std::uint8_t>(components), ::draco::DT_FLOAT32, false,
                 stride, 0);
  const int id = cloud->AddAttribute(attribute, true, cloud->num_points());
  cloud->attribute(id)->buffer()->Write(0, values.data(), values.size() * sizeof(float));
}

bool Encode(const ::draco::PointCloud& points, const Box& box, const Grid& grid,
            const XyzSettings& settings, float intensity_range, ::draco::EncoderBuffer* buffer) {
  ::draco::Encoder encoder;
  const int speed = 10 - std::clamp(settings.level, 0, 10);
  encoder.SetSpeedOptions(speed, speed);
  const bool kd_tree = settings.method == XyzMethod::kKdTree || grid.bits > kMaxSequentialBits;
  encoder.SetEncodingMethod(kd_tree ? ::draco::POINT_CLOUD_KD_TREE_ENCODING
                                    : ::draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
  const double cells = static_cast<double>((1U << grid.bits) - 1);
  encoder.SetAttributeExplicitQuantization(GeometryAttribute::POSITION, grid.bits, 3,
                                           box.low.data(), static_cast<float>(grid.step_m * cells));
  const float zero = 0;
  if (points.num_attributes() > 1) {
    encoder.SetAttributeExplicitQuantization(GeometryAttribute::GENERIC,
                                             static_cast<int>(settings.intensity_bits), 1, &zero,
                                             intensity_range);
  }
  return encoder.EncodePointCloudToBuffer(points, buffer).ok();
}

/// Makes the decoder return quantised attributes as integers. Draco's own conversion to floats
/// takes a fifth of the decoding time.
void LeaveQuantized(::draco::Decoder* decoder) {
  decoder->SetSkipAttributeTransform(GeometryAttribute::POSITION);
  decoder->SetSkipAttributeTransform(GeometryAttribute::GENERIC);
}

/// Converts the quantised integers in `bytes` to `values`, with the same rounding in floats as in
/// Draco.
template <std::size_t kComponents>
bool FromGrid(const ::draco::PointAttribute& attribute, const std::uint8_t* bytes,
              std::vector<float>* values) {
  ::draco::AttributeQuantizationTransform grid;
  if (!grid.InitFromAttribute(attribute) || grid.quantization_bits() < 1 ||
      grid.quantization_bits() > kMaxBits) {
    return false;
  }
  std::array<float, kComponents> low;
  std::copy_n(grid.min_values().begin(), kComponents, low.begin());
  const float step = grid.range() / static_cast<float>((1U << grid.quantization_bits()) - 1);
  for (std::size_t i = 0; i < values->size(); i += kComponents) {
    for (std::size_t axis = 0; axis < kComponents; ++axis) {
      std::int32_t cell = 0;
      std::memcpy(&cell, bytes + (i + axis) * sizeof cell, sizeof cell);
      (*values)[i + axis] = static_cast<float>(cell) * step + low[axis];
    }
  }
  return true;
}

/// Copies the attribute of this type to `values`. Returns false unless it has kComponents finite
/// numbers for each point.
template <std::size_t kComponents>
bool GetAttribute(const ::draco::PointCloud& cloud, GeometryAttribute::Type type,
                  std::vector<float>* values) {
  const ::draco::PointAttribute* attribute = cloud.GetNamedAttribute(type);
  const std::size_t count = std::size_t{cloud.num_points()} * kComponents;
  if (attribute == nullptr || attribute->num_components() != kComponents ||
      !attribute->is_mapping_identity() || attribute->size() < cloud.num_points() ||
      attribute->byte_stride() != static_cast<std::int64_t>(sizeof(float) * kComponents) ||
      attribute->buffer()->data_size() < count * sizeof(float)) {
    return false;
  }
  values->resize(count);
  const std::uint8_t* bytes = attribute->buffer()->data();
  if (attribute->data_type() == ::draco::DT_FLOAT32) {
    std::memcpy(values->data(), bytes, count * sizeof(float));
  } else if (!FromGrid<kComponents>(*attribute, bytes, values)) {
    return false;
  }
  return std::all_of(values->begin(), values->end(), [](float v) { return std::isfinite(v); });
}

}  // namespace

double LongestSide(const XyzCloud& cloud) { return cloud.size() == 0 ? 0 : BoxOf(cloud).extent; }

bool EncodeXyz(const XyzCloud& cloud, const XyzSettings& settings, std::vector<std::uint8_t>* out,
               XyzResult* result) {
  if (cloud.size() == 0) return false;
  const Box box = BoxOf(cloud);
  const auto grid = GridOf(box, settings);
  if (!grid) return false;
  ::draco::PointCloud points;
  points.set_num_points(static_cast<std::uint32_t>(cloud.size()));
  AddAttribute(GeometryAttribute::POSITION, 3, cloud.xyz, &points);
  float largest = 0;
  if (settings.intensity_bits > 0 && cloud.intensity.size() == cloud.size()) {
    AddAttribute(GeometryAttribute::GENERIC, 1, cloud.intensity, &points);
    largest = *std::max_element(cloud.intensity.begin(), cloud.intensity.end());
  }
  ::draco::EncoderBuffer buffer;
  if (!Encode(points, box, *grid, settings, largest > 0 ? largest : 1, &buffer)) return false;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(buffer.data());
  out->insert(out->end(), bytes, bytes + buffer.size());
  *result = {grid->step_m, grid->error_m};
  return true;
}

bool DecodeXyz(ByteView stream, std::uint32_t max_points, XyzCloud* cloud) {
  cloud->Clear();
  const auto summary = CheckDraco(stream, {max_points});
  if (!summary) return false;
  try {
    ::draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data), stream.size);
    ::draco::Decoder decoder;
    LeaveQuantized(&decoder);
    auto decoded = decoder.DecodePointCloudFromBuffer(&buffer);
    if (!decoded.ok()) return false;
    const ::draco::PointCloud& points = *decoded.value();
    return points.num_points() == summary->points &&
           GetAttribute<3>(points, GeometryAttribute::POSITION, &cloud->xyz) &&
           (points.GetNamedAttribute(GeometryAttribute::GENERIC) == nullptr ||
            GetAttribute<1>(points, GeometryAttribute::GENERIC, &cloud->intensity));
  } catch (const std::bad_alloc&) {
    return false;
  } catch (const std::length_error&) {
    return false;
  }
}

}  // namespace lidar::draco
