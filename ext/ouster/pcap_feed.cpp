// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/pcap_feed.h"

#include <algorithm>
#include <utility>

namespace lidar::gst {

std::unique_ptr<PcapFeed> PcapFeed::Open(const std::string& path, const ouster::Metadata& metadata,
                                         bool loop, std::string* error) {
  auto reader = ouster::PcapReader::Open(path, error);
  if (!reader) return nullptr;
  std::unique_ptr<PcapFeed> feed(new PcapFeed);
  feed->reader_ = std::move(reader);
  feed->packet_size_ = metadata.format.packet_size();
  feed->packet_interval_ = metadata.packet_interval();
  feed->loop_ = loop;
  return feed;
}

bool PcapFeed::StartOver() {
  if (!loop_ || !found_ || !reader_->Rewind()) return false;
  round_start_ += last_ - *first_ + packet_interval_;
  first_.reset();
  starts_over_ = true;
  return true;
}

std::optional<PcapFeed::Packet> PcapFeed::Next() {
  constexpr std::size_t kMaxSizes = 64;  // number of different payload sizes to count
  auto captured = reader_->Next();
  if (!captured) {
    error_ = reader_->error();
    if (!StartOver()) return std::nullopt;
    captured = reader_->Next();
    if (!captured) return std::nullopt;
  }
  Packet packet;
  packet.payload = std::move(captured->datagram.payload);
  packet.captured = captured->time;
  packet.sender = captured->datagram.addresses.source;
  if (!first_) first_ = captured->time;
  last_ = std::max(captured->time, last_);
  packet.due = round_start_ + std::max(Duration{0}, captured->time - *first_);
  packet.starts_over = std::exchange(starts_over_, false);
  found_ = found_ || packet.payload.size() == packet_size_;
  if (!found_ && sizes_.size() < kMaxSizes) ++sizes_[packet.payload.size()];
  return packet;
}

bool PcapFeed::Reposition(Time first, std::optional<std::int64_t> offset) {
  // The reader is always rewound first, because after an error it reads no more.
  if (!reader_->Rewind() || (offset && !reader_->GoTo(*offset))) return false;
  first_ = last_ = first;
  return true;
}

std::string PcapFeed::DescribeContents() const {
  if (sizes_.empty()) return "it has no whole UDP datagrams (tcpdump -s 0 captures whole ones)";
  const auto most = std::max_element(
      sizes_.begin(), sizes_.end(),
      [](const auto& a, const auto& b) { return a.second * a.first < b.second * b.first; });
  return "it has " + std::to_string(most->second) + " datagrams of " + std::to_string(most->first) +
         " bytes, but the metadata describes packets of " + std::to_string(packet_size_) + " bytes";
}

}  // namespace lidar::gst
