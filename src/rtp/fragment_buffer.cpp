// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/fragment_buffer.h"

#include "src/base/sequence.h"

namespace lidar::rtp {
namespace {

// The size of a map node and its vector. It is counted, because it is most of the memory of a tiny
// fragment.
constexpr std::size_t kFragmentOverhead = 96;

}  // namespace

FragmentBuffer::Added FragmentBuffer::Add(std::uint16_t sequence, const Unit& unit) {
  if (!base_) base_ = sequence;
  const int at = SequenceDistance(sequence, *base_);
  if (fragments_.count(at) != 0) return Added::kDuplicate;
  const bool starts = StartsUnit(unit.type);
  const bool ends = EndsUnit(unit.type);
  if ((first_ && (starts || at < *first_)) || (last_ && (ends || at > *last_)))
    return Added::kContradiction;
  fragments_.emplace(at, std::vector<std::uint8_t>(unit.body.begin(), unit.body.end()));
  cost_ += unit.body.size + kFragmentOverhead;
  if (starts) {
    first_ = at;
    start_ = unit;
    start_->body = {};
    Drop(fragments_.begin(), fragments_.lower_bound(at));
  }
  if (ends) {
    last_ = at;
    Drop(fragments_.upper_bound(at), fragments_.end());
  }
  return Added::kStored;
}

void FragmentBuffer::Drop(std::map<int, std::vector<std::uint8_t>>::iterator from,
                          std::map<int, std::vector<std::uint8_t>>::iterator to) {
  for (auto it = from; it != to; ++it) cost_ -= it->second.size() + kFragmentOverhead;
  fragments_.erase(from, to);
}

bool FragmentBuffer::IsWhole() const {
  return first_ && last_ && *last_ - *first_ + 1 == static_cast<int>(fragments_.size());
}

std::optional<std::vector<std::uint8_t>> FragmentBuffer::Join() const {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(cost_);
  for (const auto& [at, body] : fragments_) bytes.insert(bytes.end(), body.begin(), body.end());
  if (bytes.size() != start_->length ||
      UnitCrc(*start_, {bytes.data(), bytes.size()}) != start_->crc)
    return std::nullopt;
  return bytes;
}

std::optional<std::uint16_t> FragmentBuffer::start_sequence() const {
  if (!first_) return std::nullopt;
  return static_cast<std::uint16_t>(*base_ + *first_);
}

}  // namespace lidar::rtp
