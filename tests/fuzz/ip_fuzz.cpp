// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the frames of a capture down to UDP, and reassembles IP fragments. The first byte of the
// input chooses the link type. Each frame that follows has its size in 2 bytes before it.
#include "src/ouster/udp_datagram.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using lidar::ouster::LinkType;
  static const LinkType links[] = {LinkType::kNull, LinkType::kEthernet, LinkType::kRaw,
                                   LinkType::kLoop, LinkType::kLinuxSll, LinkType::kIpv4,
                                   LinkType::kIpv6, LinkType::kLinuxSll2};
  lidar::ByteReader r(data, size);
  const LinkType link = links[r.U8() & 7];
  lidar::ouster::UdpExtractor extractor;
  while (r.ok() && r.remaining() > 0) {
    const std::size_t n = r.Be16();
    const auto frame = r.Bytes(std::min(n, r.remaining()));
    const auto datagram = extractor.Extract(link, frame);
    if (datagram) FUZZ_CHECK(datagram->payload.size() <= 65'535);
  }
  return 0;
}
