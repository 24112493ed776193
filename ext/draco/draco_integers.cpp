// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/draco_integers.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>

#include <new>

#include "ext/draco/draco_check.h"

namespace lidar::draco {
namespace {

constexpr auto kGeneric = ::draco::GeometryAttribute::GENERIC;
constexpr int kFastest = 10;

/// Adds `list` as an attribute. Draco's builder is not used, because it would search for
/// duplicates.
template <class T>
void AddList(const std::vector<T>& list, ::draco::DataType type, ::draco::PointCloud* cloud) {
  ::draco::GeometryAttribute attribute;
  attribute.Init(kGeneric, nullptr, 1, type, false, sizeof(T), 0);
  const auto count = static_cast<std::uint32_t>(list.size());
  const int id = cloud->AddAttribute(attribute, true, count);
  cloud->attribute(id)->buffer()->Write(0, list.data(), list.size() * sizeof(T));
}

template <class T>
bool GetList(const ::draco::PointCloud& cloud, int index, std::vector<T>* list) {
  const ::draco::PointAttribute* attribute = cloud.attribute(index);
  const auto count = cloud.num_points();
  if (attribute == nullptr || attribute->num_components() != 1) return false;
  if (attribute->byte_stride() != static_cast<std::int64_t>(sizeof(T)) ||
      !attribute->is_mapping_identity() || attribute->size() < count) {
    return false;
  }
  list->resize(count);
  attribute->buffer()->Read(0, list->data(), count * sizeof(T));
  return true;
}

}  // namespace

const DracoIntegers* DracoIntegers::Shared() {
  static const DracoIntegers integers;
  return &integers;
}

bool DracoIntegers::Encode(const codec::IntegerLists& lists, bool delta,
                           std::vector<std::uint8_t>* out) const {
  if (lists.values.empty()) return false;
  ::draco::PointCloud cloud;
  cloud.set_num_points(static_cast<std::uint32_t>(lists.values.size()));
  AddList(lists.values, ::draco::DT_INT32, &cloud);
  if (!lists.levels.empty()) AddList(lists.levels, ::draco::DT_UINT8, &cloud);
  ::draco::Encoder encoder;
  encoder.SetSpeedOptions(kFastest, kFastest);
  encoder.SetEncodingMethod(::draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
  if (!delta) encoder.SetAttributePredictionScheme(kGeneric, ::draco::PREDICTION_NONE);
  ::draco::EncoderBuffer buffer;
  if (!encoder.EncodePointCloudToBuffer(cloud, &buffer).ok()) return false;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(buffer.data());
  out->insert(out->end(), bytes, bytes + buffer.size());
  return true;
}

bool DracoIntegers::Decode(ByteView stream, std::uint32_t count, bool has_levels,
                           codec::IntegerLists* lists) const {
  const auto summary = CheckDraco(stream, {count});
  if (!summary || summary->points != count || summary->is_kd_tree) return false;
  try {
    ::draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data), stream.size);
    ::draco::Decoder decoder;
    auto decoded = decoder.DecodePointCloudFromBuffer(&buffer);
    if (!decoded.ok()) return false;
    const ::draco::PointCloud& cloud = *decoded.value();
    lists->levels.clear();
    return cloud.num_points() == count && cloud.num_attributes() == (has_levels ? 2 : 1) &&
           GetList(cloud, 0, &lists->values) && (!has_levels || GetList(cloud, 1, &lists->levels));
  } catch (const std::bad_alloc&) {
    return false;
  } catch (const std::length_error&) {
    return false;
  }
}

}  // namespace lidar::draco
