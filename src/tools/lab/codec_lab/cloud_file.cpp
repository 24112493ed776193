// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/cloud_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "src/cloud/cloud_files.h"
#include "src/cloud/field_number.h"
#include "src/tools/common/output_file.h"

namespace lidar::tools {
namespace {

void AddPoint(const float* xyz, const float* intensity, Scan* scan) {
  if (!std::isfinite(xyz[0]) || !std::isfinite(xyz[1]) || !std::isfinite(xyz[2])) return;
  if (xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0) return;
  scan->xyz.insert(scan->xyz.end(), xyz, xyz + 3);
  if (intensity != nullptr) scan->intensity.push_back(*intensity);
}

const PointField* Find(const FileCloud& cloud, const char* name) {
  const auto found = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                  [&](const PointField& f) { return f.name == name; });
  return found == cloud.fields.end() ? nullptr : &*found;
}

float Number(const std::uint8_t* point, const PointField& field, bool swap) {
  return static_cast<float>(ReadNumber(point + field.offset, field.type, swap));
}

Scan ReadBin(const std::string& path, const std::string& bytes) {
  constexpr std::size_t kPoint = 4 * sizeof(float);
  if (bytes.empty() || bytes.size() % kPoint != 0)
    throw std::runtime_error(path + ": not a list of x y z intensity floats");
  Scan scan;
  for (std::size_t i = 0; i < bytes.size(); i += kPoint) {
    float point[4];
    std::memcpy(point, bytes.data() + i, sizeof point);
    AddPoint(point, point + 3, &scan);
  }
  return scan;
}

}  // namespace

bool IsCloudFile(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  const std::string end = dot == std::string::npos ? "" : path.substr(dot);
  return end == ".bin" || end == ".pcd" || end == ".ply";
}

Scan ReadCloud(const std::string& path) {
  const std::string bytes = ReadFile(path);
  const ByteView view{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  if (path.size() >= 4 && path.compare(path.size() - 4, 4, ".bin") == 0)
    return ReadBin(path, bytes);
  std::string why = "neither a PCD nor a PLY file";
  const auto type = TypeOfCloudFile(view);
  std::optional<FileCloud> cloud;
  if (type) cloud = *type == CloudFileType::kPcd ? ReadPcd(view, &why) : ReadPly(view, &why);
  if (!cloud) throw std::runtime_error(path + ": " + why);
  const PointField* x = Find(*cloud, "x");
  const PointField* y = Find(*cloud, "y");
  const PointField* z = Find(*cloud, "z");
  const PointField* intensity = Find(*cloud, "intensity");
  if (x == nullptr || y == nullptr || z == nullptr)
    throw std::runtime_error(path + ": no fields x, y and z");
  Scan scan;
  for (std::size_t at = 0; at + cloud->point_step <= cloud->points.size() && cloud->point_step > 0;
       at += cloud->point_step) {
    const auto number = [&](const PointField& f) {
      return Number(&cloud->points[at], f, cloud->is_bigendian);
    };
    const float xyz[3] = {number(*x), number(*y), number(*z)};
    const float level = intensity != nullptr ? number(*intensity) : 0;
    AddPoint(xyz, intensity != nullptr ? &level : nullptr, &scan);
  }
  return scan;
}

}  // namespace lidar::tools
