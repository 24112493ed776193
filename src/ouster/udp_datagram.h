// SPDX-License-Identifier: LGPL-2.1-or-later
// Extracts UDP datagrams from captured frames: Ethernet (with VLAN), Linux cooked, loopback and raw
// IP; IPv4 and IPv6, with reassembly of fragments.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/time.h"

namespace lidar::ouster {

/// Link-layer types of capture files (the LINKTYPE_ registry of tcpdump.org).
enum class LinkType : std::uint32_t {
  kNull = 0,
  kEthernet = 1,
  kRaw = 101,
  kLoop = 108,
  kLinuxSll = 113,
  kIpv4 = 228,
  kIpv6 = 229,
  kLinuxSll2 = 276,
};

/// Returns false for a type that Extract() cannot read.
bool IsKnown(LinkType link);

struct IpEndpoints {
  bool is_ipv6 = false;
  std::array<std::uint8_t, 16> source{};  // the first 4 bytes for IPv4
  std::array<std::uint8_t, 16> destination{};
  bool operator==(const IpEndpoints& o) const {
    return is_ipv6 == o.is_ipv6 && source == o.source && destination == o.destination;
  }
};

struct UdpDatagram {
  IpEndpoints addresses;
  std::vector<std::uint8_t> payload;

  ByteView view() const { return {payload.data(), payload.size()}; }
};

/// Reassembles fragments. Holds a bounded number of datagrams for a short time; contradicting
/// fragments discard their datagram (RFC 5722).
class IpReassembler {
 public:
  struct Fragment {
    IpEndpoints addresses;
    std::uint32_t id = 0;
    std::size_t offset = 0;  // bytes, a multiple of 8
    bool more = false;
    ByteView payload;
  };
  /// Returns the whole IP payload if `fragment` completes it.
  std::optional<std::vector<std::uint8_t>> Add(const Fragment& fragment, Time time);

 private:
  struct Partial {
    IpEndpoints addresses;
    std::uint32_t id = 0;
    Time begun{};
    std::vector<std::uint8_t> bytes;
    std::vector<bool> blocks;  // of 8 bytes
    std::optional<std::size_t> size;
    std::size_t received = 0;
  };
  std::deque<Partial>::iterator Find(const Fragment& fragment, Time time);

  std::deque<Partial> partials_;  // oldest first
};

class UdpExtractor {
 public:
  /// Returns nothing for a frame that is not UDP, is damaged or cut short, or is a fragment whose
  /// datagram is not complete. `time`: of the capture.
  std::optional<UdpDatagram> Extract(LinkType link, ByteView frame, Time time = {});

 private:
  std::optional<UdpDatagram> FromIp(ByteView packet);
  std::optional<UdpDatagram> FromIpv4(ByteView packet);
  std::optional<UdpDatagram> FromIpv6(ByteView packet);
  std::optional<UdpDatagram> FromFragment(const IpReassembler::Fragment& fragment);

  IpReassembler reassembler_;
  Time time_{};  // of the present frame
};

}  // namespace lidar::ouster
