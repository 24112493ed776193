// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/reference_keeper.h"

#include <algorithm>
#include <utility>

namespace lidar::codec {

void ReferenceKeeper::Release(const std::vector<BlockMemoryPtr>& blocks) {
  for (const BlockMemoryPtr& block : blocks) bytes_ -= block->bytes();
}

void ReferenceKeeper::Forget() {
  for (auto& [index, slot] : slots_) Restart(&slot);
}

void ReferenceKeeper::Restart(Slot* slot) {
  for (const Sent& sent : slot->sent) Release(sent.blocks);
  Release(slot->reference);
  slot->sent.clear();
  slot->reference.clear();
}

void ReferenceKeeper::OnAcknowledged(Time now, std::uint32_t receiver, std::uint32_t scan_id,
                                     std::uint32_t index) {
  if (receiver_ != receiver) {
    // A second receiver, or a receiver after a restart, does not have the blocks of the first one.
    if (receiver_) alone_since_ = now + kPatience;
    receiver_ = receiver;
    Forget();
  }
  last_heard_ = now;
  const auto found = slots_.find(index);
  if (found == slots_.end()) return;
  Slot& slot = found->second;
  const auto is_it = [&](const Sent& sent) { return sent.scan_id == scan_id; };
  const auto sent = std::find_if(slot.sent.begin(), slot.sent.end(), is_it);
  if (sent == slot.sent.end()) return;
  Release(slot.reference);
  slot.reference = std::move(sent->blocks);
  for (auto older = slot.sent.begin(); older != sent; ++older) Release(older->blocks);
  slot.sent.erase(slot.sent.begin(), sent + 1);
}

void ReferenceKeeper::OnKeyRequest() { Forget(); }

bool ReferenceKeeper::Begin(Time now, const SliceName& slice) {
  current_ = nullptr;
  if (!receiver_) return false;
  if (now - last_heard_ > kPatience) {
    receiver_.reset();
    slots_.clear();
    bytes_ = 0;
    return false;
  }
  if (now < alone_since_) return false;
  Slot& slot = slots_[slice.index];
  if (key_interval_ > Duration{0}) {
    // The sectors restart in different scans. If all slices of a scan had no reference, that scan
    // would be much larger than the others.
    const Duration head_start = key_interval_ * slice.index / std::max(slice.count, 1U);
    const auto turn = [&](Time t) { return (t.time_since_epoch() + head_start) / key_interval_; };
    if (turn(now) != turn(slot.begun.value_or(now))) Restart(&slot);
  }
  slot.begun = now;
  if (slot.sent.size() >= kMostOfSlice || bytes_ >= kMostBytes) Restart(&slot);
  current_ = &slot;
  name_ = slice;
  return bytes_ < kMostBytes;
}

BlockMemoryPtr ReferenceKeeper::Reference(const RangeImage& image) const {
  if (current_ == nullptr) return nullptr;
  for (const BlockMemoryPtr& block : current_->reference)
    if (block->Fits(image)) return block;
  return nullptr;
}

void ReferenceKeeper::OnEncoded(std::vector<BlockMemoryPtr> blocks) {
  if (current_ == nullptr || blocks.empty()) return;
  // An acknowledgement consists of scan id and index. It would be ambiguous if two slices had the
  // same numbers.
  const auto same = [&](const Sent& sent) { return sent.scan_id == name_.scan_id; };
  if (std::any_of(current_->sent.begin(), current_->sent.end(), same)) return Restart(current_);
  for (const BlockMemoryPtr& block : blocks) bytes_ += block->bytes();
  current_->sent.push_back({name_.scan_id, std::move(blocks)});
}

}  // namespace lidar::codec
