// SPDX-License-Identifier: LGPL-2.1-or-later
// The interface of an external coder. It codes lists of integers: the bins and levels of a block.
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

  /// Encodes `lists`, which are not empty, and appends the stream to `out`. If `delta`, the coder
  /// predicts each integer by the integer before it. Returns false if the coder fails.
  virtual bool Encode(const IntegerLists& lists, bool delta,
                      std::vector<std::uint8_t>* out) const = 0;

  /// Decodes `stream` to `lists`. Returns false if the stream does not have exactly `count` values,
  /// or has levels although `has_levels` is false, or vice versa.
  virtual bool Decode(ByteView stream, std::uint32_t count, bool has_levels,
                      IntegerLists* lists) const = 0;
};

}  // namespace lidar::codec
