// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/delivery.h"

namespace lidar::rtp {

void Delivery::Forget() {
  packets_.clear();
  slices_.clear();
}

void Delivery::DropFirst() {
  packets_.pop_front();
  ++first_seq_;
  const std::uint64_t needed =
      packets_.empty() ? first_slice_ + slices_.size() : packets_.front().slice;
  while (first_slice_ < needed) {
    slices_.pop_front();
    ++first_slice_;
  }
}

void Delivery::OnSent(const Packet& packet) {
  const auto next = static_cast<std::uint16_t>(first_seq_ + packets_.size());
  if (ssrc_ != packet.ssrc || packet.seq != next) {
    Forget();
    ssrc_ = packet.ssrc;
    first_seq_ = packet.seq;
  }
  if (slices_.empty() || slices_.back().ended) slices_.push_back({packet.slice, 0, false});
  SentSlice& slice = slices_.back();
  ++slice.missing;
  slice.ended = packet.ends_slice;
  packets_.push_back({first_slice_ + slices_.size() - 1, false});
  while (packets_.size() > kMostPackets) DropFirst();
}

std::vector<Delivery::Slice> Delivery::OnReceived(std::uint32_t ssrc, std::uint16_t first,
                                                  std::uint16_t last) {
  std::vector<Slice> arrived;
  if (ssrc_ != ssrc) return arrived;
  const std::size_t count = std::size_t{static_cast<std::uint16_t>(last - first)} + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<std::uint16_t>(first + i - first_seq_);
    if (at >= packets_.size() || packets_[at].received) continue;
    packets_[at].received = true;
    SentSlice& slice = slices_[packets_[at].slice - first_slice_];
    --slice.missing;
    if (slice.ended && slice.missing == 0) arrived.push_back(slice.name);
  }
  while (!packets_.empty() && packets_.front().received) DropFirst();
  return arrived;
}

}  // namespace lidar::rtp
