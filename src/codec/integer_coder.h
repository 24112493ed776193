// SPDX-License-Identifier: LGPL-2.1-or-later
// The interface of an external coder of integers: lists of a block's bins and levels.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::codec {

struct IntegerLists {
  std::vector<std::int32_t> values;
  std::vector<std::uint8_t> levels;  // one for each value, or empty
};

/// Codes the payloads of RangeCoder::kDraco and kResidual. Threads may share an instance.
class IntegerCoder {
 public:
  virtual ~IntegerCoder() = default;

  /// Appends the stream of `lists`, which are not empty, to `out`. With `delta`, each integer is
  /// predicted by the one before. Returns false if the coder fails.
  virtual bool Encode(const IntegerLists& lists, bool delta,
                      std::vector<std::uint8_t>* out) const = 0;

  /// Fills `lists` from a stream of exactly `count` integers, with levels or without. Returns false
  /// for any other stream.
  virtual bool Decode(ByteView stream, std::uint32_t count, bool has_levels,
                      IntegerLists* lists) const = 0;
};

}  // namespace lidar::codec
