// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds on the pipes from the sender and the receiver to the program that compares them.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lidar::demo {

struct SliceKey {
  std::uint32_t scan = 0;
  std::uint32_t slice = 0;
};
inline bool operator<(const SliceKey& a, const SliceKey& b) {
  return a.scan != b.scan ? a.scan < b.scan : a.slice < b.slice;
}

struct Cloud {
  SliceKey key;
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<float> xyz;  // three a point, row-major
};

/// Both ends are on one machine: native byte order.
std::string WriteFrame(const Cloud& cloud);

/// Blocks on `fd`. Returns nothing at its end or for an invalid frame.
std::optional<Cloud> ReadFrame(int fd);

}  // namespace lidar::demo
