// SPDX-License-Identifier: LGPL-2.1-or-later
// The bins and levels of a block as lists of integers, and how a coder of another library is given
// them.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::codec {

struct IntegerLists {
  std::vector<std::int32_t> values;
  std::vector<std::uint8_t> levels;  // as many as values, or none
};

/// What codes the payloads of RangeCoder::kDraco and kResidual. Any number of threads may share
/// one.
class IntegerCoder {
 public:
  virtual ~IntegerCoder() = default;

  /// Appends the stream of `lists`, which are not empty, to `out`. With `delta`, the coder predicts
  /// each integer as the one before it. False where the coder fails.
  virtual bool Encode(const IntegerLists& lists, bool delta,
                      std::vector<std::uint8_t>* out) const = 0;

  /// Fills `lists` from a stream of exactly `count` integers, with levels or without; false where
  /// the stream is another.
  virtual bool Decode(ByteView stream, std::uint32_t count, bool has_levels,
                      IntegerLists* lists) const = 0;
};

}  // namespace lidar::codec
