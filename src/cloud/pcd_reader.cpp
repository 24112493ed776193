// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads PCD files up to version 0.7: text, binary, and binary compressed with LZF.
#include <lzf.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "src/cloud/cloud_file_parts.h"
#include "src/cloud/cloud_files.h"

namespace lidar {
namespace {

using cloud_file::FileField;
using Words = std::vector<std::string_view>;

std::optional<FieldType> TypeOf(std::string_view type, std::uint64_t size) {
  struct Row {
    char type;
    std::uint64_t size;
    FieldType field;
  };
  constexpr Row kRows[] = {{'I', 1, FieldType::kI8},  {'U', 1, FieldType::kU8},
                           {'I', 2, FieldType::kI16}, {'U', 2, FieldType::kU16},
                           {'I', 4, FieldType::kI32}, {'U', 4, FieldType::kU32},
                           {'F', 4, FieldType::kF32}, {'F', 8, FieldType::kF64}};
  for (const Row& row : kRows)
    if (type.size() == 1 && type[0] == row.type && size == row.size) return row.field;
  return std::nullopt;
}

/// The lines of the header in text form.
struct PcdHeader {
  Words fields, sizes, types, counts;
  std::optional<std::uint64_t> width, height, points;
  std::string data;
  std::optional<std::uint64_t> capture_time;
};

/// Reads the lines up to DATA. Returns nothing if there is no line DATA.
std::optional<PcdHeader> ReadPcdHeader(cloud_file::Lines* lines) {
  PcdHeader header;
  while (const auto words = lines->Next()) {
    if (words->empty()) continue;
    const std::string_view key = words->front();
    const Words values(words->begin() + 1, words->end());
    const auto count = values.empty() ? std::nullopt : cloud_file::ParseCount(values[0]);
    if (key[0] == '#' && !header.capture_time)
      header.capture_time = cloud_file::ParseCaptureTime(lines->text());
    else if (key == "FIELDS" || key == "COLUMNS")
      header.fields = values;
    else if (key == "SIZE")
      header.sizes = values;
    else if (key == "TYPE")
      header.types = values;
    else if (key == "COUNT")
      header.counts = values;
    else if (key == "WIDTH")
      header.width = count;
    else if (key == "HEIGHT")
      header.height = count;
    else if (key == "POINTS")
      header.points = count;
    else if (key == "DATA" && !values.empty()) {
      header.data = values[0];
      return header;
    }
  }
  return std::nullopt;
}

std::optional<std::vector<FileField>> Fields(const PcdHeader& h, std::string* why) {
  *why = "FIELDS, SIZE, TYPE and COUNT do not match";
  if (h.sizes.size() != h.fields.size() || h.types.size() != h.fields.size() ||
      (!h.counts.empty() && h.counts.size() != h.fields.size()))
    return std::nullopt;
  std::vector<FileField> fields;
  for (std::size_t i = 0; i < h.fields.size(); ++i) {
    const auto size = cloud_file::ParseCount(h.sizes[i]);
    const auto count = h.counts.empty() ? 1 : cloud_file::ParseCount(h.counts[i]);
    if (!size || !count || *size == 0 || *size > 8 || *count > cloud_file::kMaxHeader)
      return std::nullopt;
    const std::string name(h.fields[i]);
    const bool usable =
        name != "_" && name.find_first_of(",:") == std::string::npos &&
        std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c <= '~'; });
    fields.push_back({usable ? name : "", TypeOf(h.types[i], *size),
                      static_cast<std::uint32_t>(*size), static_cast<std::uint32_t>(*count)});
  }
  return fields;
}

bool SetSize(const PcdHeader& h, FileCloud* cloud, std::string* why) {
  const std::uint64_t height = h.height.value_or(1);
  const std::uint64_t width = h.width.value_or(h.points.value_or(0));
  *why = "WIDTH, HEIGHT and POINTS do not match";
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (width > kMost || height > kMost || height == 0) return false;
  if (h.points && *h.points != width * height) return false;
  cloud->width = static_cast<std::uint32_t>(width);
  cloud->height = static_cast<std::uint32_t>(height);
  return true;
}

/// The best compression ratio of the format: a back reference of three bytes gives 264 bytes.
constexpr std::size_t kMostPerByte = 88;

/// Decompresses `data`. Returns nothing if the data are damaged or do not give exactly `size`
/// bytes.
std::optional<std::vector<std::uint8_t>> DecompressLzf(ByteView data, std::size_t size) {
  // The library reads the first byte without checking that it exists.
  if (data.size == 0 || size / kMostPerByte > data.size) return std::nullopt;
  std::vector<std::uint8_t> out(size);
  if (lzf_decompress(data.data, static_cast<unsigned>(data.size), out.data(),
                     static_cast<unsigned>(size)) != size)
    return std::nullopt;
  return out;
}

/// Reads compressed points. The file has the first field of all points, then the second field of
/// all points, and so on.
bool ReadCompressed(ByteView rest, const std::vector<FileField>& fields, FileCloud* cloud,
                    std::string* why) {
  ByteReader r(rest);
  const std::uint32_t compressed = r.Le32();
  const std::uint32_t uncompressed = r.Le32();
  const ByteView data = r.Bytes(compressed);
  const auto size = cloud_file::SizeOfPoints(*cloud, why);
  if (!size) return false;
  *why = "the compressed points are damaged";
  if (!r.ok() || uncompressed != *size) return false;
  if (*size == 0) return true;
  const auto planes = DecompressLzf(data, *size);
  if (!planes) return false;
  cloud->points.resize(*size);
  const std::size_t points = *size / cloud->point_step;
  const std::uint8_t* from = planes->data();
  std::size_t offset = 0;
  for (const FileField& f : fields) {
    const std::size_t width = std::size_t{f.size} * f.count;
    for (std::size_t i = 0; i < points; ++i, from += width)
      std::memcpy(cloud->points.data() + i * cloud->point_step + offset, from, width);
    offset += width;
  }
  return true;
}

bool ReadBinary(ByteView rest, FileCloud* cloud, std::string* why) {
  const auto size = cloud_file::SizeOfPoints(*cloud, why);
  if (!size) return false;
  *why = "the file ends before its last point";
  if (rest.size < *size) return false;
  cloud->points.assign(rest.data, rest.data + *size);
  return true;
}

}  // namespace

std::optional<FileCloud> ReadPcd(ByteView file, std::string* why) {
  cloud_file::Lines lines(file);
  const auto header = ReadPcdHeader(&lines);
  *why = "its header has no line DATA";
  if (!header) return std::nullopt;
  const auto fields = Fields(*header, why);
  FileCloud cloud;
  cloud.capture_time = header->capture_time;
  if (!fields || !SetSize(*header, &cloud, why) || !cloud_file::Lay(*fields, &cloud, why))
    return std::nullopt;
  bool read = false;
  if (header->data == "ascii")
    read = cloud_file::ReadText(lines.Rest(), *fields, &cloud, why);
  else if (header->data == "binary")
    read = ReadBinary(lines.Rest(), &cloud, why);
  else if (header->data == "binary_compressed")
    read = ReadCompressed(lines.Rest(), *fields, &cloud, why);
  else
    *why = "DATA is neither ascii, binary nor binary_compressed";
  if (!read) return std::nullopt;
  return cloud;
}

}  // namespace lidar
