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

/// Returns false if Extract() cannot read frames of this type.
bool IsKnown(LinkType link);

struct IpEndpoints {
  bool is_ipv6 = false;
  std::array<std::uint8_t, 16> source{};  // for IPv4, only the first 4 bytes are used
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

/// Reassembles IP fragments. Keeps a bounded number of incomplete datagrams for a few seconds.
/// Drops a datagram if its fragments overlap (RFC 5722), but ignores an exact copy of a fragment.
class IpReassembler {
 public:
  struct Fragment {
    IpEndpoints addresses;
    std::uint32_t id = 0;
    std::size_t offset = 0;  // in bytes; a multiple of 8
    bool more = false;
    ByteView payload;
  };
  /// Returns the complete IP payload if `fragment` is its last missing part.
  std::optional<std::vector<std::uint8_t>> Add(const Fragment& fragment, Time time);

 private:
  struct Partial {
    IpEndpoints addresses;
    std::uint32_t id = 0;
    Time begun{};
    std::vector<std::uint8_t> bytes;
    std::vector<bool> blocks;  // true for each block of 8 bytes that arrived
    std::optional<std::size_t> size;
    std::size_t received = 0;
  };
  std::deque<Partial>::iterator Find(const Fragment& fragment, Time time);

  std::deque<Partial> partials_;  // oldest first
};

class UdpExtractor {
 public:
  /// Returns the UDP datagram of a captured frame. Returns nothing if the frame is not UDP, is
  /// damaged or is cut short, or if it is a fragment of a datagram that is not complete yet. `time`
  /// is the capture time.
  std::optional<UdpDatagram> Extract(LinkType link, ByteView frame, Time time = {});

 private:
  std::optional<UdpDatagram> FromIp(ByteView packet);
  std::optional<UdpDatagram> FromIpv4(ByteView packet);
  std::optional<UdpDatagram> FromIpv6(ByteView packet);
  std::optional<UdpDatagram> FromFragment(const IpReassembler::Fragment& fragment);

  IpReassembler reassembler_;
  Time time_{};  // capture time of the current frame
};

}  // namespace lidar::ouster
