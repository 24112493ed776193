// SPDX-License-Identifier: LGPL-2.1-or-later
// PCD, PLY, LAS and KITTI's files.
#include "src/cloud/cloud_files.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const lidar::ByteView file{data, size};
  lidar::TypeOfCloudFile(file);
  std::string why;
  for (const auto& cloud : {lidar::ReadPcd(file, &why), lidar::ReadPly(file, &why),
                            lidar::ReadLas(file, &why), lidar::ReadKitti(file, &why)}) {
    if (!cloud) continue;
    const std::size_t points = std::size_t{cloud->width} * cloud->height;
    FUZZ_CHECK(cloud->points.size() == points * cloud->point_step);
    // A byte of text gives at most 4 bytes, a byte of LZF at most 88.
    FUZZ_CHECK(cloud->points.size() <= 90 * size);
    for (const auto& field : cloud->fields)
      FUZZ_CHECK(field.offset + lidar::SizeOf(field.type) <= cloud->point_step);
  }
  return 0;
}
