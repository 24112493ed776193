// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds from files: PCD (Point Cloud Library), PLY (Stanford), LAS (ASPRS) and KITTI's. Files may
// hold any bytes.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"

namespace lidar {

enum class CloudFileType { kPcd, kPly, kLas, kKitti };

/// Detects the type from the beginning of `file`; a few hundred bytes suffice. KITTI's files have
/// no header: plausible points identify them.
std::optional<CloudFileType> TypeOfCloudFile(ByteView file);

struct FileCloud {
  std::vector<PointField> fields;  // with the file's names, without fields that we cannot use
  std::uint32_t point_step = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 1;
  bool is_bigendian = false;
  std::optional<std::uint64_t> capture_time;  // [ns since 1970], if we wrote the file
  std::vector<std::uint8_t> points;
};

/// Returns nothing if the file is damaged or of an unsupported kind; `why` then has the reason for
/// a user. The sizes that the file claims are checked against its bytes.
std::optional<FileCloud> ReadPcd(ByteView file, std::string* why);
std::optional<FileCloud> ReadPly(ByteView file, std::string* why);
/// LAS 1.0 to 1.4, point formats 0 to 10, uncompressed. F32 has no millimetres beyond 16 km. If a
/// coordinate exceeds this, the least x, y and z, in whole metres, are subtracted from all points.
std::optional<FileCloud> ReadLas(ByteView file, std::string* why);
/// Reads x, y, z and intensity as F32, the format of KITTI's sequences and their successors.
std::optional<FileCloud> ReadKitti(ByteView file, std::string* why);
std::optional<FileCloud> ReadCloud(CloudFileType type, ByteView file, std::string* why);

}  // namespace lidar
