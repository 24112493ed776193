// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads clouds from files: PCD (Point Cloud Library), PLY (Stanford), LAS (ASPRS) and KITTI. Files
// are not trusted; they may contain any bytes.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"

namespace lidar {

enum class CloudFileType { kPcd, kPly, kLas, kKitti };

/// Detects the type from the beginning of a file, of which a few hundred bytes are enough. KITTI
/// files have no header, so they are recognised by plausible points.
std::optional<CloudFileType> TypeOfCloudFile(ByteView file);

struct FileCloud {
  // The fields of the file that a cloud can have, with their names in the file.
  std::vector<PointField> fields;
  std::uint32_t point_step = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 1;
  bool is_bigendian = false;
  std::optional<std::uint64_t> capture_time;  // ns since 1970, if our elements wrote the file
  std::vector<std::uint8_t> points;
};

/// Reads a file. Sizes in the header are checked against the size of the file. If the file is
/// damaged or not supported, returns nothing and sets `why` to a reason for the user.
std::optional<FileCloud> ReadPcd(ByteView file, std::string* why);
std::optional<FileCloud> ReadPly(ByteView file, std::string* why);
/// Reads uncompressed LAS 1.0 to 1.4 with point formats 0 to 10. Beyond 16 km, F32 cannot represent
/// millimetres. If a coordinate exceeds this limit, the least x, y and z, rounded down to metres,
/// are subtracted from all points.
std::optional<FileCloud> ReadLas(ByteView file, std::string* why);
/// Reads the format of the KITTI data sets and their successors: x, y, z and intensity as F32.
std::optional<FileCloud> ReadKitti(ByteView file, std::string* why);
std::optional<FileCloud> ReadCloud(CloudFileType type, ByteView file, std::string* why);

}  // namespace lidar
