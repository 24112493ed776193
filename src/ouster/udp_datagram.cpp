// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/udp_datagram.h"

#include <algorithm>

namespace lidar::ouster {
namespace {

constexpr std::size_t kMaxPartials = 32;
constexpr std::size_t kMaxIpPayload = 65535;
constexpr std::size_t kFragmentUnit = 8;
// Fragments that are older than this are dropped, because IP identifiers are reused within minutes.
constexpr Duration kMaxAge = std::chrono::seconds(5);
constexpr std::uint8_t kUdp = 17;
constexpr std::uint16_t kEtherIpv4 = 0x0800;
constexpr std::uint16_t kEtherIpv6 = 0x86dd;

/// Returns the IP packet that follows the Ethernet header and VLAN tags. Returns an empty view if
/// the frame is not IP.
ByteView AfterEthernet(ByteView frame) {
  constexpr int kMaxTags = 4;
  ByteReader r(frame);
  r.Skip(12);
  std::uint16_t type = r.Be16();
  for (int tag = 0; tag < kMaxTags && (type == 0x8100 || type == 0x88a8); ++tag) {
    r.Skip(2);
    type = r.Be16();
  }
  return r.ok() && (type == kEtherIpv4 || type == kEtherIpv6) ? r.Rest() : ByteView{};
}

ByteView AfterLinkHeader(LinkType link, ByteView frame) {
  switch (link) {
    case LinkType::kEthernet:
      return AfterEthernet(frame);
    case LinkType::kLinuxSll:
      return frame.Sub(16);
    case LinkType::kLinuxSll2:
      return frame.Sub(20);
    case LinkType::kNull:
    case LinkType::kLoop:
      return frame.Sub(4);
    case LinkType::kRaw:
    case LinkType::kIpv4:
    case LinkType::kIpv6:
      return frame;
  }
  return {};
}

void CopyAddress(ByteView from, std::array<std::uint8_t, 16>* to) {
  std::copy(from.begin(), from.end(), to->begin());
}

std::optional<UdpDatagram> ParseUdp(const IpEndpoints& addresses, ByteView bytes) {
  constexpr std::size_t kUdpHeaderSize = 8;
  ByteReader r(bytes);
  UdpDatagram datagram;
  datagram.addresses = addresses;
  r.Skip(4);  // ports
  const std::size_t length = r.Be16();
  r.Skip(2);  // checksum: network cards fill it in after the capture, so it is often wrong
  if (!r.ok() || length < kUdpHeaderSize || length > bytes.size) return std::nullopt;
  const ByteView payload = r.Bytes(length - kUdpHeaderSize);
  datagram.payload.assign(payload.begin(), payload.end());
  return datagram;
}

}  // namespace

bool IsKnown(LinkType link) {
  switch (link) {
    case LinkType::kNull:
    case LinkType::kEthernet:
    case LinkType::kRaw:
    case LinkType::kLoop:
    case LinkType::kLinuxSll:
    case LinkType::kIpv4:
    case LinkType::kIpv6:
    case LinkType::kLinuxSll2:
      return true;
  }
  return false;
}

/// Returns the incomplete datagram that the fragment `f` belongs to. If there is none, adds a new
/// datagram.
std::deque<IpReassembler::Partial>::iterator IpReassembler::Find(const Fragment& f, Time time) {
  auto at = std::find_if(partials_.begin(), partials_.end(), [&](const Partial& p) {
    return p.id == f.id && p.addresses == f.addresses;
  });
  if (at != partials_.end() && (time > at->begun + kMaxAge || time + kMaxAge < at->begun)) {
    partials_.erase(at);
    at = partials_.end();
  }
  if (at != partials_.end()) return at;
  if (partials_.size() == kMaxPartials) partials_.pop_front();
  partials_.emplace_back();
  partials_.back().addresses = f.addresses;
  partials_.back().id = f.id;
  partials_.back().begun = time;
  return partials_.end() - 1;
}

std::optional<std::vector<std::uint8_t>> IpReassembler::Add(const Fragment& f, Time time) {
  const std::size_t end = f.offset + f.payload.size;
  if (f.payload.empty() || end > kMaxIpPayload || (f.more && f.payload.size % kFragmentUnit != 0))
    return std::nullopt;
  const auto at = Find(f, time);
  Partial& p = *at;
  const std::size_t first_block = f.offset / kFragmentUnit;
  const std::size_t last_block = (end - 1) / kFragmentUnit;
  if (p.blocks.size() <= last_block) p.blocks.resize(last_block + 1);
  if (p.bytes.size() < end) p.bytes.resize(end);
  const auto first = p.blocks.begin() + static_cast<std::ptrdiff_t>(first_block);
  const auto last = p.blocks.begin() + static_cast<std::ptrdiff_t>(last_block) + 1;
  const bool overlaps = std::find(first, last, true) != last;
  const bool repeats = overlaps && std::find(first, last, false) == last &&
                       std::equal(f.payload.begin(), f.payload.end(),
                                  p.bytes.begin() + static_cast<std::ptrdiff_t>(f.offset));
  if (repeats) return std::nullopt;
  if (!f.more && !p.size) p.size = end;
  if (overlaps || (p.size && p.bytes.size() > *p.size)) {
    partials_.erase(at);
    return std::nullopt;
  }
  std::fill(first, last, true);
  std::copy(f.payload.begin(), f.payload.end(),
            p.bytes.begin() + static_cast<std::ptrdiff_t>(f.offset));
  p.received += f.payload.size;
  if (!p.size || p.received < *p.size) return std::nullopt;
  std::vector<std::uint8_t> whole = std::move(p.bytes);
  partials_.erase(at);
  return whole;
}

std::optional<UdpDatagram> UdpExtractor::Extract(LinkType link, ByteView frame, Time time) {
  time_ = time;
  return FromIp(AfterLinkHeader(link, frame));
}

std::optional<UdpDatagram> UdpExtractor::FromIp(ByteView packet) {
  if (packet.empty()) return std::nullopt;
  switch (packet.data[0] >> 4) {
    case 4:
      return FromIpv4(packet);
    case 6:
      return FromIpv6(packet);
    default:
      return std::nullopt;
  }
}

std::optional<UdpDatagram> UdpExtractor::FromIpv4(ByteView packet) {
  ByteReader r(packet);
  const std::size_t header_size = (r.U8() & 0xfU) * std::size_t{4};
  r.Skip(1);
  std::size_t total = r.Be16();
  IpReassembler::Fragment f;
  f.id = r.Be16();
  const std::uint16_t flags = r.Be16();
  r.Skip(1);
  const std::uint8_t protocol = r.U8();
  r.Skip(2);
  CopyAddress(r.Bytes(4), &f.addresses.source);
  CopyAddress(r.Bytes(4), &f.addresses.destination);
  // A length of 0 comes from segmentation offload: the network card fills in the length later.
  if (total == 0) total = packet.size;
  if (!r.ok() || protocol != kUdp || header_size < 20 || total < header_size || total > packet.size)
    return std::nullopt;
  f.offset = (flags & 0x1fffU) * kFragmentUnit;
  f.more = (flags & 0x2000U) != 0;
  f.payload = packet.Sub(header_size, total - header_size);
  return FromFragment(f);
}

std::optional<UdpDatagram> UdpExtractor::FromIpv6(ByteView packet) {
  constexpr int kMaxExtensions = 8;
  ByteReader r(packet);
  IpReassembler::Fragment f;
  f.addresses.is_ipv6 = true;
  r.Skip(4);
  const std::size_t length = r.Be16();
  std::uint8_t next = r.U8();
  r.Skip(1);
  CopyAddress(r.Bytes(16), &f.addresses.source);
  CopyAddress(r.Bytes(16), &f.addresses.destination);
  if (!r.ok() || length > r.remaining()) return std::nullopt;
  ByteReader body(r.Bytes(length));
  for (int i = 0; i < kMaxExtensions && next != kUdp; ++i) {
    constexpr std::uint8_t kHopByHop = 0;
    constexpr std::uint8_t kRouting = 43;
    constexpr std::uint8_t kFragmentHeader = 44;
    constexpr std::uint8_t kDestination = 60;
    const std::uint8_t type = next;
    next = body.U8();
    if (type == kFragmentHeader) {
      body.Skip(1);
      const std::uint16_t where = body.Be16();
      f.offset = where & 0xfff8U;
      f.more = (where & 1U) != 0;
      f.id = body.Be32();
    } else if (type == kHopByHop || type == kRouting || type == kDestination) {
      const std::size_t units = body.U8();
      body.Skip(6 + units * 8);
    } else {
      return std::nullopt;
    }
    if (f.offset > 0) break;  // only the first fragment has further headers
  }
  if (!body.ok() || next != kUdp) return std::nullopt;
  f.payload = body.Rest();
  return FromFragment(f);
}

std::optional<UdpDatagram> UdpExtractor::FromFragment(const IpReassembler::Fragment& f) {
  if (f.offset == 0 && !f.more) return ParseUdp(f.addresses, f.payload);
  const auto whole = reassembler_.Add(f, time_);
  if (!whole) return std::nullopt;
  return ParseUdp(f.addresses, {whole->data(), whole->size()});
}

}  // namespace lidar::ouster
