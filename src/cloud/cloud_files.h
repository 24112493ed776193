// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds from files: PCD (Point Cloud Library), PLY (Stanford), LAS (ASPRS) and KITTI's. Any bytes
// may come.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"

namespace lidar {

enum class CloudFileType { kPcd, kPly, kLas, kKitti };

/// Judges by how `file` begins; a few hundred bytes of it are enough. A file of KITTI's has no
/// header: plausible points are one.
std::optional<CloudFileType> TypeOfCloudFile(ByteView file);

struct FileCloud {
  std::vector<PointField> fields;  // as the file names them; what we cannot use is left out
  std::uint32_t point_step = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 1;
  bool is_bigendian = false;
  std::optional<std::uint64_t> capture_time;  // ns since 1970, where we wrote the file
  std::vector<std::uint8_t> points;
};

/// Returns nothing if the file is damaged or of an unsupported kind; `why` then says so for a user.
/// Its claimed sizes are checked against its bytes.
std::optional<FileCloud> ReadPcd(ByteView file, std::string* why);
std::optional<FileCloud> ReadPly(ByteView file, std::string* why);
/// LAS 1.0 to 1.4, point formats 0 to 10, uncompressed. x, y and z are as the file has them, or,
/// where a point lies more than 16 km off, relative to the least of each in whole metres: F32 has
/// no millimetres beyond that.
std::optional<FileCloud> ReadLas(ByteView file, std::string* why);
/// x, y, z and intensity as F32, of KITTI's sequences and what was made after them.
std::optional<FileCloud> ReadKitti(ByteView file, std::string* why);
std::optional<FileCloud> ReadCloud(CloudFileType type, ByteView file, std::string* why);

}  // namespace lidar
