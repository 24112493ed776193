// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/field_codec.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>

#include <algorithm>
#include <limits>
#include <new>
#include <stdexcept>

#include "ext/draco/draco_check.h"
#include "src/cloud/field_number.h"

namespace lidar::draco {
namespace {

using Attribute = ::draco::GeometryAttribute;

// The default of both speeds in draco_point_cloud_transport.
constexpr int kSpeed = 7;
// Draco's integer coder needs memory and time in proportion to the range of the differences.
constexpr double kWidestRange = 1 << 20;
// Draco stores the number of components of a field in a byte.
constexpr std::uint32_t kMostNumbers = 255;

/// Returns Draco's type for a field. Draco converts integers to int32 and refuses values that are
/// larger. So a U32 field is declared as int32, which does not change its bits.
::draco::DataType DracoTypeOf(FieldType type) {
  constexpr ::draco::DataType kTypes[] = {
      ::draco::DT_INT8,  ::draco::DT_UINT8, ::draco::DT_INT16,   ::draco::DT_UINT16,
      ::draco::DT_INT32, ::draco::DT_INT32, ::draco::DT_FLOAT32, ::draco::DT_FLOAT64};
  return kTypes[static_cast<std::size_t>(type)];
}

std::size_t BytesOf(const FieldOfPoints& field) { return SizeOf(field.type) * field.count; }

bool FitsPoint(const FieldLayout& layout) {
  const auto fits = [&](const FieldOfPoints& f) {
    return f.count >= 1 && f.count <= kMostNumbers && f.offset + BytesOf(f) <= layout.point_step;
  };
  return !layout.fields.empty() && layout.fields.size() <= FieldLayout::kMaxFields &&
         std::all_of(layout.fields.begin(), layout.fields.end(), fits);
}

std::uint32_t LongestField(const FieldLayout& layout) {
  std::uint32_t longest = 0;
  for (const FieldOfPoints& field : layout.fields) longest = std::max(longest, field.count);
  return longest;
}

void AddField(const FieldOfPoints& field, ByteView points, std::uint32_t point_step,
              ::draco::PointCloud* cloud) {
  const std::size_t size = BytesOf(field);
  Attribute attribute;
  attribute.Init(field.is_position ? Attribute::POSITION : Attribute::GENERIC, nullptr,
                 static_cast<std::uint8_t>(field.count), DracoTypeOf(field.type), false,
                 static_cast<std::int64_t>(size), 0);
  const int id = cloud->AddAttribute(attribute, true, cloud->num_points());
  ::draco::DataBuffer* buffer = cloud->attribute(id)->buffer();
  for (std::uint32_t i = 0; i < cloud->num_points(); ++i)
    buffer->Write(static_cast<std::int64_t>(i * size),
                  points.data + std::size_t{i} * point_step + field.offset, size);
}

/// Copies the attribute to the field of each point. Returns false if its values do not have the
/// size of the field.
bool CopyField(const ::draco::PointAttribute& attribute, const FieldOfPoints& field,
               const FieldLayout& layout, std::vector<std::uint8_t>* points) {
  const std::size_t size = BytesOf(field);
  const std::size_t count = points->size() / layout.point_step;
  const std::size_t values = attribute.size();
  if (attribute.byte_stride() != static_cast<std::int64_t>(size) ||
      attribute.buffer()->data_size() < values * size)
    return false;
  for (std::size_t i = 0; i < count; ++i) {
    const auto index =
        attribute.mapped_index(::draco::PointIndex(static_cast<std::uint32_t>(i))).value();
    if (index >= values) return false;
    std::copy_n(attribute.buffer()->data() + index * size, size,
                points->data() + i * layout.point_step + field.offset);
  }
  return true;
}

bool CopyPoints(const ::draco::PointCloud& cloud, const FieldLayout& layout,
                std::vector<std::uint8_t>* points) {
  if (static_cast<std::size_t>(cloud.num_attributes()) != layout.fields.size()) return false;
  points->assign(std::size_t{cloud.num_points()} * layout.point_step, 0);
  for (std::size_t i = 0; i < layout.fields.size(); ++i)
    if (!CopyField(*cloud.attribute(static_cast<int>(i)), layout.fields[i], layout, points))
      return false;
  return true;
}

/// Returns the difference between the largest and the smallest number in the field.
double RangeOf(const FieldOfPoints& field, ByteView points, std::uint32_t point_step) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (std::size_t at = field.offset; at + BytesOf(field) <= points.size; at += point_step) {
    for (std::uint32_t i = 0; i < field.count; ++i) {
      const double value = ReadNumber(points.data + at + i * SizeOf(field.type), field.type);
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  return high - low;
}

/// Returns true if the range of an integer field is greater than kWidestRange.
bool HasWideIntegers(ByteView points, const FieldLayout& layout) {
  return std::any_of(layout.fields.begin(), layout.fields.end(), [&](const FieldOfPoints& f) {
    return (f.type == FieldType::kI32 || f.type == FieldType::kU32) &&
           RangeOf(f, points, layout.point_step) > kWidestRange;
  });
}

}  // namespace

bool EncodeFields(ByteView points, const FieldLayout& layout, std::vector<std::uint8_t>* out) try {
  if (!FitsPoint(layout) || points.size < layout.point_step) return false;
  ::draco::PointCloud cloud;
  cloud.set_num_points(static_cast<std::uint32_t>(points.size / layout.point_step));
  for (const FieldOfPoints& field : layout.fields)
    AddField(field, points, layout.point_step, &cloud);
  ::draco::Encoder encoder;
  encoder.SetSpeedOptions(kSpeed, kSpeed);
  encoder.SetEncodingMethod(::draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
  if (HasWideIntegers(points, layout)) {
    // Integers are stored without compression, which every Draco decoder can read.
    encoder.options().SetGlobalBool("use_built_in_attribute_compression", false);
    for (const auto type : {Attribute::POSITION, Attribute::GENERIC})
      encoder.SetAttributePredictionScheme(type, ::draco::PREDICTION_NONE);
  }
  ::draco::EncoderBuffer buffer;
  if (!encoder.EncodePointCloudToBuffer(cloud, &buffer).ok()) return false;
  out->assign(buffer.data(), buffer.data() + buffer.size());
  return true;
} catch (const std::bad_alloc&) {
  return false;
}

bool DecodeFields(ByteView stream, const FieldLayout& layout, std::uint32_t max_points,
                  std::vector<std::uint8_t>* points) {
  if (!FitsPoint(layout)) return false;
  const auto summary =
      CheckDraco(stream, {max_points, FieldLayout::kMaxFields, LongestField(layout), true});
  if (!summary) return false;
  try {
    ::draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data), stream.size);
    ::draco::Decoder decoder;
    const auto decoded = decoder.DecodePointCloudFromBuffer(&buffer);
    return decoded.ok() && decoded.value()->num_points() == summary->points &&
           CopyPoints(*decoded.value(), layout, points);
  } catch (const std::bad_alloc&) {
    return false;
  } catch (const std::length_error&) {
    return false;
  }
}

}  // namespace lidar::draco
