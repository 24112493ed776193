// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/fileenc/cloud_file_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "src/cloud/field_number.h"

namespace lidar::gst {
namespace {

struct TypeText {
  char pcd;
  const char* ply;
};

TypeText TextOf(FieldType type) {
  switch (type) {
    case FieldType::kI8:
      return {'I', "char"};
    case FieldType::kU8:
      return {'U', "uchar"};
    case FieldType::kI16:
      return {'I', "short"};
    case FieldType::kU16:
      return {'U', "ushort"};
    case FieldType::kI32:
      return {'I', "int"};
    case FieldType::kU32:
      return {'U', "uint"};
    case FieldType::kF32:
      return {'F', "float"};
    case FieldType::kF64:
      break;
  }
  return {'F', "double"};
}

/// Returns field names that are safe in a file header. Names come from caps, so characters that
/// would break the header are replaced. Names are also made unique, because readers ignore the
/// second of two fields with the same name.
std::vector<std::string> SafeNames(const PointFields& fields) {
  std::vector<std::string> names;
  for (const PointField& f : fields.all()) {
    std::string name = f.name;
    for (char& c : name)
      if (g_ascii_isalnum(c) == FALSE) c = '_';
    while (std::find(names.begin(), names.end(), name) != names.end()) name += '_';
    names.push_back(std::move(name));
  }
  return names;
}

bool IsCoordinate(const PointField& field) {
  return field.type == FieldType::kF32 &&
         (field.name == "x" || field.name == "y" || field.name == "z");
}

/// Appends the shortest text that is parsed to exactly the same number. The text does not depend on
/// the locale.
void AppendText(FieldType type, const std::uint8_t* at, std::string* out) {
  WithTypeOf(type, [&](auto value) {
    std::memcpy(&value, at, sizeof value);
    if (std::isnan(static_cast<double>(value))) {
      *out += "nan";
      return;
    }
    std::array<char, 40> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
    out->append(text.data(), end.ptr);
  });
}

/// Writes points with all fields, but without the gaps between fields.
class PointWriter {
 public:
  explicit PointWriter(const CloudFileInput& cloud)
      : cloud_(cloud), fields_(cloud.info->fields.all()) {
    for (const PointField& f : fields_)
      if (IsCoordinate(f)) coordinates_.push_back(&f);
  }

  bool HasReturn(const std::uint8_t* point) const {
    if (coordinates_.size() < 3) return true;
    bool zero = true;
    for (const PointField* f : coordinates_) {
      float v = 0;
      std::memcpy(&v, point + f->offset, sizeof v);
      if (!std::isfinite(v)) return false;
      zero = zero && v == 0.0F;
    }
    return !zero;
  }
  gsize CountReturns() const {
    gsize count = 0;
    for (gsize i = 0; i < cloud_.info->Points(); ++i) count += HasReturn(At(i)) ? 1U : 0U;
    return count;
  }
  /// Appends the points. If `keep_missing` is true, the coordinates of a point without a return are
  /// NaN. Otherwise points without a return are omitted.
  void AppendAll(bool keep_missing, std::string* out) const {
    for (gsize i = 0; i < cloud_.info->Points(); ++i) {
      const bool missing = !HasReturn(At(i));
      if (!missing || keep_missing) Append(At(i), missing, out);
    }
  }

 private:
  const std::uint8_t* At(gsize i) const { return cloud_.points + i * cloud_.info->point_step; }
  void Append(const std::uint8_t* point, bool missing, std::string* out) const {
    static constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    std::array<std::uint8_t, sizeof kNan> nan{};
    std::memcpy(nan.data(), &kNan, sizeof kNan);
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const PointField& f = fields_[i];
      const std::uint8_t* at = missing && IsCoordinate(f) ? nan.data() : point + f.offset;
      if (cloud_.binary) {
        out->append(reinterpret_cast<const char*>(at), SizeOf(f.type));
      } else {
        if (i > 0) *out += ' ';
        AppendText(f.type, at, out);
      }
    }
    if (!cloud_.binary) *out += '\n';
  }

  const CloudFileInput& cloud_;
  const std::vector<PointField>& fields_;
  std::vector<const PointField*> coordinates_;
};

std::string CaptureComment(const CloudFileInput& cloud, const char* mark) {
  if (!cloud.capture_time) return "";
  std::string nanoseconds = std::to_string(*cloud.capture_time % GST_SECOND);
  nanoseconds.insert(0, 9 - nanoseconds.size(), '0');
  return std::string(mark) + " capture time [s since 1970-01-01T00:00:00Z]: " +
         std::to_string(*cloud.capture_time / GST_SECOND) + "." + nanoseconds + "\n";
}

}  // namespace

std::string WritePcd(const CloudFileInput& cloud) {
  const CloudInfo& info = *cloud.info;
  const PointWriter points(cloud);
  const bool organised = info.height > 1;
  const gsize count = organised ? info.Points() : points.CountReturns();
  std::string names, sizes, types, counts;
  for (const std::string& name : SafeNames(info.fields)) names += " " + name;
  for (const PointField& f : info.fields.all()) {
    sizes += " " + std::to_string(SizeOf(f.type));
    types += std::string(" ") + TextOf(f.type).pcd;
    counts += " 1";
  }
  std::string out = "# .PCD v0.7 - Point Cloud Data file format\n";
  out += CaptureComment(cloud, "#");
  out += "VERSION 0.7\nFIELDS" + names + "\nSIZE" + sizes + "\nTYPE" + types + "\nCOUNT" + counts;
  out += "\nWIDTH " + std::to_string(organised ? info.width : count);
  out += "\nHEIGHT " + std::to_string(info.height);
  out += "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(count);
  out += cloud.binary ? "\nDATA binary\n" : "\nDATA ascii\n";
  points.AppendAll(organised, &out);
  return out;
}

std::string WritePly(const CloudFileInput& cloud) {
  const PointWriter points(cloud);
  std::string out = "ply\nformat ";
  out += cloud.binary ? "binary_little_endian 1.0\n" : "ascii 1.0\n";
  out += CaptureComment(cloud, "comment");
  out += "element vertex " + std::to_string(points.CountReturns()) + "\n";
  const std::vector<std::string> names = SafeNames(cloud.info->fields);
  auto name = names.begin();
  for (const PointField& f : cloud.info->fields.all())
    out += std::string("property ") + TextOf(f.type).ply + " " + *name++ + "\n";
  out += "end_header\n";
  points.AppendAll(false, &out);
  return out;
}

}  // namespace lidar::gst
