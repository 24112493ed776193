// SPDX-License-Identifier: LGPL-2.1-or-later
// A slice of an organised scan as integers: the input and the output of the range codec.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lidar::codec {

/// The pixels are in row-major order, beam by beam: pixel i of a beam is at [beam * columns + i].
struct RangeImage {
  std::uint32_t beams = 0;
  std::uint32_t columns = 0;
  std::uint32_t first_column = 0;       // measurement id of the first column
  std::vector<std::uint32_t> ranges;    // mm; 0: no return
  std::vector<std::uint8_t> intensity;  // levels; empty: intensity is not coded

  std::size_t size() const { return std::size_t{beams} * columns; }
};

}  // namespace lidar::codec
