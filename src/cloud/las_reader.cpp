// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads LAS 1.0 to 1.4 (ASPRS), with point records of formats 0 to 10.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "src/base/byte_writer.h"
#include "src/cloud/cloud_file_parts.h"
#include "src/cloud/cloud_files.h"

namespace lidar {
namespace {

using Vector = std::array<double, 3>;

constexpr std::size_t kHeader10 = 227;  // size of the header in versions 1.0 to 1.2 [bytes]
constexpr std::size_t kHeader14 = 375;
constexpr double kFineReach = 16'384;  // limit up to which F32 can represent millimetres [m]

/// Offsets of fields in a record. The offset is 0 if the format does not have the field.
struct PointFormat {
  std::uint32_t size;
  std::uint32_t time, colour, infrared;
};
// See table 7 and later tables of the specification. The formats from 6 on have a longer first
// part.
constexpr PointFormat kFormats[] = {{20, 0, 0, 0},   {28, 20, 0, 0},  {26, 0, 20, 0},
                                    {34, 20, 28, 0}, {57, 20, 0, 0},  {63, 20, 28, 0},
                                    {30, 22, 0, 0},  {36, 22, 30, 0}, {38, 22, 30, 36},
                                    {59, 22, 0, 0},  {67, 22, 30, 36}};
constexpr unsigned kFirstLong = 6;
// The short formats have flags in the upper bits of the class.
constexpr std::uint32_t kShortClass = 15;
constexpr std::uint8_t kShortClassBits = 0x1F;

struct LasHeader {
  std::uint32_t points_at = 0;
  unsigned format = 0;
  std::uint32_t step = 0;  // size of a record [bytes]
  std::uint64_t points = 0;
  Vector scale{}, offset{};
};

std::vector<PointField> FieldsOf(unsigned format) {
  const PointFormat& f = kFormats[format];
  const bool is_long = format >= kFirstLong;
  std::vector<PointField> fields = {
      {"x", FieldType::kF32, 0},
      {"y", FieldType::kF32, 4},
      {"z", FieldType::kF32, 8},
      {"intensity", FieldType::kU16, 12},
      {"classification", FieldType::kU8, is_long ? 16U : kShortClass},
      {"user_data", FieldType::kU8, 17},
      {"point_source_id", FieldType::kU16, is_long ? 20U : 18U},
  };
  if (f.time > 0) fields.push_back({"gps_time", FieldType::kF64, f.time});
  if (f.colour > 0) {
    fields.push_back({"red", FieldType::kU16, f.colour});
    fields.push_back({"green", FieldType::kU16, f.colour + 2});
    fields.push_back({"blue", FieldType::kU16, f.colour + 4});
  }
  if (f.infrared > 0) fields.push_back({"nir", FieldType::kU16, f.infrared});
  return fields;
}

bool AreUsable(const LasHeader& h) {
  const auto finite = [](double v) { return std::isfinite(v); };
  return std::all_of(h.scale.begin(), h.scale.end(), finite) &&
         std::all_of(h.offset.begin(), h.offset.end(), finite);
}

std::optional<LasHeader> ReadLasHeader(ByteView file, std::string* why) {
  *why = "its header is cut off";
  if (file.size < kHeader10) return std::nullopt;
  LasHeader h;
  ByteReader r(file);
  *why = "it is not LAS 1.0 to 1.4";
  r.Skip(24);  // signature, ids
  if (r.U8() != 1) return std::nullopt;
  const unsigned minor = r.U8();
  if (minor > 4 || (minor == 4 && file.size < kHeader14)) return std::nullopt;
  r.Skip(70);  // software, date, size of the header
  h.points_at = r.Le32();
  r.Skip(4);
  h.format = r.U8();
  h.step = r.Le16();
  h.points = r.Le32();
  r.Skip(20);  // number of points by return
  for (double& v : h.scale) v = r.LeF64();
  for (double& v : h.offset) v = r.LeF64();
  if (minor == 4) h.points = ByteReader(file.Sub(247, 8)).Le64();
  *why = "its points are compressed (LAZ): convert the file to LAS";
  if ((h.format & 0xC0U) != 0) return std::nullopt;
  *why = "its point format is unknown, or its records are too short for it";
  if (h.format >= std::size(kFormats) || h.step < kFormats[h.format].size) return std::nullopt;
  *why = "its scale or offset is not a finite number";
  if (!AreUsable(h)) return std::nullopt;
  return h;
}

Vector Position(const std::uint8_t* record, const LasHeader& h) {
  ByteReader r(record, 12);
  Vector p;
  for (unsigned k = 0; k < 3; ++k)
    p[k] = static_cast<double>(static_cast<std::int32_t>(r.Le32())) * h.scale[k] + h.offset[k];
  return p;
}

/// Returns the position that is subtracted from all points.
Vector OriginOf(ByteView records, const LasHeader& h) {
  Vector least;
  least.fill(std::numeric_limits<double>::infinity());
  double farthest = 0;
  for (std::size_t at = 0; at < records.size; at += h.step) {
    const Vector p = Position(records.data + at, h);
    for (unsigned k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], p[k]);
      farthest = std::max(farthest, std::abs(p[k]));
    }
  }
  if (farthest <= kFineReach) return {};
  for (double& v : least) v = std::floor(v);
  return least;
}

}  // namespace

std::optional<FileCloud> ReadLas(ByteView file, std::string* why) {
  const auto header = ReadLasHeader(file, why);
  if (!header) return std::nullopt;
  FileCloud cloud;
  cloud.fields = FieldsOf(header->format);
  cloud.point_step = header->step;
  *why = "the cloud is larger than 1 GiB";
  if (header->points > cloud_file::kMaxCloud / header->step) return std::nullopt;
  const std::size_t size = header->points * header->step;
  const ByteView records = file.Sub(header->points_at, size);
  *why = "the file ends before its last point";
  if (records.size < size) return std::nullopt;
  cloud.width = static_cast<std::uint32_t>(header->points);
  cloud.points.reserve(size);
  const Vector origin = OriginOf(records, *header);
  ByteWriter w(&cloud.points);
  for (std::size_t at = 0; at < size; at += header->step) {
    const Vector p = Position(records.data + at, *header);
    for (unsigned k = 0; k < 3; ++k) w.LeF32(static_cast<float>(p[k] - origin[k]));
    cloud.points.insert(cloud.points.end(), records.data + at + 12,
                        records.data + at + header->step);
    if (header->format < kFirstLong) cloud.points[at + kShortClass] &= kShortClassBits;
  }
  return cloud;
}

}  // namespace lidar
