// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes lists of integers as a Draco point cloud. Each list is an attribute.
#pragma once
#include "src/codec/integer_coder.h"

namespace lidar::draco {

class DracoIntegers : public codec::IntegerCoder {
 public:
  bool Encode(const codec::IntegerLists& lists, bool delta,
              std::vector<std::uint8_t>* out) const override;
  bool Decode(ByteView stream, std::uint32_t count, bool has_levels,
              codec::IntegerLists* lists) const override;
  /// Returns an object for all callers. It has no state.
  static const DracoIntegers* Shared();
};

}  // namespace lidar::draco
