// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/unit_check.h"

namespace lidar::rtp {

bool UnitCheck::Push(std::uint16_t sequence, ByteView payload) {
  bool whole = false;
  for (const Unit& unit : ParsePayload(payload)) whole = PushUnit(sequence, unit) || whole;
  return whole;
}

bool UnitCheck::PushUnit(std::uint16_t sequence, const Unit& unit) {
  if (StartsUnit(unit.type)) {
    first_.reset();
    if (!IsSlice(unit.unit) || unit.length > kMaxBytes) return false;
    first_ = unit;
    bytes_.clear();
  } else if (!first_ || sequence != next_sequence_) {
    first_.reset();
    return false;
  }
  next_sequence_ = static_cast<std::uint16_t>(sequence + 1);
  if (bytes_.size() + unit.body.size > first_->length) {
    first_.reset();
    return false;
  }
  bytes_.insert(bytes_.end(), unit.body.begin(), unit.body.end());
  if (!EndsUnit(unit.type)) return false;
  const Unit first = *first_;
  first_.reset();
  return bytes_.size() == first.length &&
         UnitCrc(first, {bytes_.data(), bytes_.size()}) == first.crc;
}

}  // namespace lidar::rtp
