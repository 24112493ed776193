// SPDX-License-Identifier: LGPL-2.1-or-later
// Lists of integers as a Draco point cloud: one attribute a list.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::codec {

struct IntegerLists {
  std::vector<std::int32_t> values;
  std::vector<std::uint8_t> levels;  // as many as values, or none
};

/// Appends the stream to `out`. With `delta`, Draco predicts each integer as the one before it.
/// False where there is nothing to encode or Draco fails.
bool EncodeIntegers(const IntegerLists& lists, bool delta, std::vector<std::uint8_t>* out);

/// Fills `lists` from a stream of exactly `count` points, with levels or without; false where the
/// stream is another.
bool DecodeIntegers(ByteView stream, std::uint32_t count, bool has_levels, IntegerLists* lists);

}  // namespace lidar::codec
