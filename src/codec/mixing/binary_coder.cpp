// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/binary_coder.h"

namespace lidar::codec::mixing {

void BinaryEncoder::Finish() {
  for (unsigned shift = 32; shift >= 8; shift -= 8) {
    // The lowest number >= low_ whose lower `shift` bits are 0. These bits need not be written,
    // because a decoder reads zeros after the last byte.
    const std::uint64_t unit = std::uint64_t{1} << shift;
    const std::uint64_t value = (low_ + unit - 1) / unit * unit;
    if (value > high_) continue;
    for (unsigned at = 32; at > shift; at -= 8)
      out_->push_back(static_cast<std::uint8_t>(value >> (at - 8)));
    return;
  }
  for (unsigned at = 32; at > 0; at -= 8)
    out_->push_back(static_cast<std::uint8_t>(low_ >> (at - 8)));
}

void BinaryDecoder::Refill() {
  while ((low_ ^ high_) < 1U << 24) {
    low_ <<= 8;
    high_ = high_ << 8 | 0xFF;
    code_ = code_ << 8 | NextByte();
  }
}

}  // namespace lidar::codec::mixing
