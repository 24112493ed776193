// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads PLY 1.0 files: text, and binary in either byte order. Only the vertices are read.
#include <algorithm>
#include <limits>

#include "src/cloud/cloud_file_parts.h"
#include "src/cloud/cloud_files.h"

namespace lidar {
namespace {

using cloud_file::FileField;

std::optional<FieldType> TypeOf(std::string_view name) {
  struct Row {
    std::string_view old_name, name;
    FieldType type;
  };
  constexpr Row kRows[] = {
      {"char", "int8", FieldType::kI8},      {"uchar", "uint8", FieldType::kU8},
      {"short", "int16", FieldType::kI16},   {"ushort", "uint16", FieldType::kU16},
      {"int", "int32", FieldType::kI32},     {"uint", "uint32", FieldType::kU32},
      {"float", "float32", FieldType::kF32}, {"double", "float64", FieldType::kF64}};
  for (const Row& row : kRows)
    if (name == row.old_name || name == row.name) return row.type;
  return std::nullopt;
}

enum class Format { kNone, kText, kLittle, kBig };

/// The header of a file. It is parsed line by line.
struct PlyHeader {
  Format format = Format::kNone;
  std::optional<std::uint64_t> vertices;
  std::vector<FileField> fields;
  std::optional<std::uint64_t> capture_time;
  bool in_vertices = false;
  bool other_first = false;  // other elements are listed before the vertices

  bool Take(const std::vector<std::string_view>& words, std::string_view line, std::string* why) {
    const std::string_view key = words.front();
    if (key == "comment") {
      if (!capture_time) capture_time = cloud_file::ParseCaptureTime(line);
    } else if (key == "format" && words.size() >= 2) {
      if (words[1] == "ascii") format = Format::kText;
      if (words[1] == "binary_little_endian") format = Format::kLittle;
      if (words[1] == "binary_big_endian") format = Format::kBig;
    } else if (key == "element" && words.size() >= 3) {
      in_vertices = words[1] == "vertex" && !vertices;
      if (in_vertices) vertices = cloud_file::ParseCount(words[2]);
      if (!in_vertices && !vertices) other_first = true;
    } else if (key == "property" && in_vertices) {
      return TakeProperty(words, why);
    }
    return true;
  }
  bool TakeProperty(const std::vector<std::string_view>& words, std::string* why) {
    const auto type = words.size() == 3 ? TypeOf(words[1]) : std::nullopt;
    *why = "a property of its vertices is a list or of an unknown type";
    if (!type) return false;
    const std::string name(words[2]);
    const bool usable =
        name.find_first_of(",:") == std::string::npos &&
        std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c <= '~'; });
    fields.push_back({usable ? name : "", type, static_cast<std::uint32_t>(SizeOf(*type)), 1});
    return true;
  }
  bool IsWhole(std::string* why) const {
    *why = "its header has no known format";
    if (format == Format::kNone) return false;
    *why = "its vertices are not its first element";
    return vertices && !other_first && *vertices <= std::numeric_limits<std::int32_t>::max();
  }
};

std::optional<PlyHeader> ReadPlyHeader(cloud_file::Lines* lines, std::string* why) {
  PlyHeader header;
  *why = "its header has no end_header";
  while (const auto words = lines->Next()) {
    if (words->empty()) continue;
    if (words->front() == "end_header") {
      if (!header.IsWhole(why)) return std::nullopt;
      return header;
    }
    if (!header.Take(*words, lines->text(), why)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<FileCloud> ReadPly(ByteView file, std::string* why) {
  cloud_file::Lines lines(file);
  const auto header = ReadPlyHeader(&lines, why);
  if (!header) return std::nullopt;
  FileCloud cloud;
  cloud.capture_time = header->capture_time;
  cloud.width = static_cast<std::uint32_t>(*header->vertices);
  cloud.is_bigendian = header->format == Format::kBig;
  if (!cloud_file::Lay(header->fields, &cloud, why)) return std::nullopt;
  if (header->format == Format::kText) {
    if (!cloud_file::ReadText(lines.Rest(), header->fields, &cloud, why)) return std::nullopt;
    return cloud;
  }
  const auto size = cloud_file::SizeOfPoints(cloud, why);
  if (!size) return std::nullopt;
  const ByteView rest = lines.Rest();
  *why = "the file ends before its last point";
  if (rest.size < *size) return std::nullopt;
  cloud.points.assign(rest.data, rest.data + *size);
  return cloud;
}

}  // namespace lidar
