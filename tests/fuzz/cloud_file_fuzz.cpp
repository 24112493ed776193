// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the input as a file of PCD, PLY, LAS and KITTI.
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
    // A reader makes at most 4 bytes of points from a byte of text. LZF expands a byte to at most
    // 88 bytes.
    FUZZ_CHECK(cloud->points.size() <= 90 * size);
    for (const auto& field : cloud->fields)
      FUZZ_CHECK(field.offset + lidar::SizeOf(field.type) <= cloud->point_step);
  }
  return 0;
}
