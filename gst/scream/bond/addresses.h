// SPDX-License-Identifier: LGPL-2.1-or-later
// Parses the property bonding-addresses, which names the links of a stream.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gst/net/udp_element.h"
#include "src/bonding/packet_id.h"

namespace lidar::gst {

/// A peer, and the interface or local address by which packets to it leave (empty: any).
struct BondAddress {
  UdpTarget target;
  std::string interface;
  std::string text;  // as the property has it
};

/// Parses HOST:PORT, HOST:PORT@INTERFACE or HOST:PORT@LOCAL-ADDRESS, separated by commas. An IPv6
/// host must be in brackets, and an IPv6 local address may be. Returns nothing and sets the error
/// for other text, more than kMaxLinks, or a repeated link.
std::optional<std::vector<BondAddress>> ParseBondAddresses(const std::string& text,
                                                           std::string* error);

}  // namespace lidar::gst
