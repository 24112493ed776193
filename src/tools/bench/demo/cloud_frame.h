// SPDX-License-Identifier: LGPL-2.1-or-later
// The format in which the sender and the receiver pass clouds through pipes to the program that
// compares them.
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
  std::vector<float> xyz;  // x, y and z of each point, row by row
};

/// Converts a cloud to bytes. Uses native byte order, because both ends of the pipe are on one
/// machine.
std::string WriteFrame(const Cloud& cloud);

/// Reads a cloud from `fd`, and blocks until it is complete. Returns nothing at the end of the
/// file, or if the frame is invalid.
std::optional<Cloud> ReadFrame(int fd);

}  // namespace lidar::demo
