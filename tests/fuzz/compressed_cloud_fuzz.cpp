// SPDX-License-Identifier: LGPL-2.1-or-later
// Decompresses CompressedPointCloud2 messages that a ROS 2 peer may send: zlib, zstd and Draco.
#include "ext/ros2/cloud_compression.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The limit of the decoded points [bytes]. It is small, because a fuzzer has little memory.
  constexpr std::size_t kFuzzedBytes = 16U << 20;
  std::string why;
  const auto message = lidar::cdr::ReadCompressedCloud({data, size}, &why);
  FUZZ_CHECK(message || !why.empty());
  if (!message) return 0;
  const auto& layout = message->cloud.layout;
  const std::size_t rows = layout.height > 0 ? layout.height : 1;
  const std::size_t row = std::size_t{layout.width} * layout.point_step;
  if (row > kFuzzedBytes || rows > kFuzzedBytes || row * rows > kFuzzedBytes) return 0;
  const auto made = lidar::gst::Decompress(*message, &why);
  FUZZ_CHECK(made || !why.empty());
  if (made) FUZZ_CHECK(made->cloud.data.size == made->points.size());
  return 0;
}
