// SPDX-License-Identifier: LGPL-2.1-or-later
// The property bonding-addresses: which links a stream has.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gst/net/udp_element.h"
#include "src/bonding/packet_id.h"

namespace lidar::gst {

/// A peer, and what its packets leave by: an interface, or a local address; empty for any.
struct BondAddress {
  UdpTarget target;
  std::string interface;
  std::string text;  // as it was given
};

/// HOST:PORT or HOST:PORT@INTERFACE or HOST:PORT@LOCAL-ADDRESS, with commas between; an IPv6 host
/// in brackets. Returns nothing and sets the error for other text, more than kMaxLinks, or a
/// repeated link.
std::optional<std::vector<BondAddress>> ParseBondAddresses(const std::string& text,
                                                           std::string* error);

}  // namespace lidar::gst
