// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/cloud_files.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "src/cloud/cloud_file_parts.h"

namespace lidar {
namespace {

constexpr std::size_t kKittiPoint = 16;  // bytes

/// Returns true if the four numbers at `p` may be a point of a KITTI file. Text, integers and other
/// structs that are read as F32 have huge, tiny or invalid values.
bool IsPlausiblePoint(const float* p) {
  constexpr float kFarthest = 1000;  // [m]
  constexpr float kBrightest = 255;
  constexpr float kSmallest = 1e-9F;
  const auto is_coordinate = [](float v) {
    return v == 0 || (std::abs(v) >= kSmallest && std::abs(v) <= kFarthest);
  };
  return is_coordinate(p[0]) && is_coordinate(p[1]) && is_coordinate(p[2]) &&
         (p[3] == 0 || (p[3] >= kSmallest && p[3] <= kBrightest));
}

bool LooksLikeKitti(ByteView file) {
  bool any = false;
  ByteReader r(file);
  while (r.remaining() >= kKittiPoint) {
    const float point[] = {r.LeF32(), r.LeF32(), r.LeF32(), r.LeF32()};
    if (!IsPlausiblePoint(point)) return false;
    any = any || point[0] != 0 || point[1] != 0 || point[2] != 0;
  }
  return any;
}

}  // namespace

std::optional<CloudFileType> TypeOfCloudFile(ByteView file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data),
                              std::min<std::size_t>(file.size, 512));
  const auto begins = [&](std::string_view with) { return text.substr(0, with.size()) == with; };
  if (begins("ply\n") || begins("ply\r\n")) return CloudFileType::kPly;
  if (begins("# .PCD") || begins("#.PCD") ||
      (begins("VERSION") && text.find("\nFIELDS") != std::string_view::npos))
    return CloudFileType::kPcd;
  if (begins("LASF")) return CloudFileType::kLas;
  if (LooksLikeKitti(file)) return CloudFileType::kKitti;
  return std::nullopt;
}

std::optional<FileCloud> ReadKitti(ByteView file, std::string* why) {
  FileCloud cloud;
  for (const char* name : {"x", "y", "z", "intensity"}) {
    cloud.fields.push_back({name, FieldType::kF32, cloud.point_step});
    cloud.point_step += 4;
  }
  *why = "its size is not a multiple of 16 bytes";
  if (file.size % kKittiPoint != 0) return std::nullopt;
  *why = "the cloud is larger than 1 GiB";
  if (file.size > cloud_file::kMaxCloud) return std::nullopt;
  cloud.width = static_cast<std::uint32_t>(file.size / kKittiPoint);
  cloud.points.assign(file.begin(), file.end());
  return cloud;
}

std::optional<FileCloud> ReadCloud(CloudFileType type, ByteView file, std::string* why) {
  switch (type) {
    case CloudFileType::kPcd:
      return ReadPcd(file, why);
    case CloudFileType::kPly:
      return ReadPly(file, why);
    case CloudFileType::kLas:
      return ReadLas(file, why);
    case CloudFileType::kKitti:
      return ReadKitti(file, why);
  }
  return std::nullopt;
}

}  // namespace lidar
