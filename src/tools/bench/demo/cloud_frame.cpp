// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/cloud_frame.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace lidar::demo {
namespace {

constexpr std::uint32_t kMagic = 0x4C434C44;
constexpr std::uint64_t kMaxPoints = 1U << 26;

struct Header {
  std::uint32_t magic;
  std::uint32_t scan;
  std::uint32_t slice;
  std::uint32_t height;
  std::uint32_t width;
};

bool ReadAll(int fd, void* data, std::size_t size) {
  auto* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t n = read(fd, bytes, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

std::string WriteFrame(const Cloud& cloud) {
  const Header header{kMagic, cloud.key.scan, cloud.key.slice, cloud.height, cloud.width};
  const std::size_t bytes = cloud.xyz.size() * sizeof(float);
  std::string frame(sizeof header + bytes, '\0');
  std::memcpy(frame.data(), &header, sizeof header);
  std::memcpy(frame.data() + sizeof header, cloud.xyz.data(), bytes);
  return frame;
}

std::optional<Cloud> ReadFrame(int fd) {
  Header header{};
  if (!ReadAll(fd, &header, sizeof header) || header.magic != kMagic) return {};
  const std::uint64_t points = std::uint64_t{header.height} * header.width;
  if (points > kMaxPoints) return {};
  Cloud cloud{{header.scan, header.slice}, header.height, header.width, {}};
  cloud.xyz.resize(points * 3);
  if (!ReadAll(fd, cloud.xyz.data(), cloud.xyz.size() * sizeof(float))) return {};
  return cloud;
}

}  // namespace lidar::demo
