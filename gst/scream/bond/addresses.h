// SPDX-License-Identifier: LGPL-2.1-or-later
// Parses the property bonding-addresses, which names the links of a stream.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gst/net/udp_element.h"
#include "src/bonding/packet_id.h"

namespace lidar::gst {

/// The address of a peer, and the network interface or local address from which packets to this
/// peer are sent. If neither is given, the kernel chooses the interface.
struct BondAddress {
  UdpTarget target;
  std::string interface;
  std::string text;  // as it is written in the property
};

/// Parses links of the form HOST:PORT, HOST:PORT@INTERFACE or HOST:PORT@LOCAL-ADDRESS, separated by
/// commas. An IPv6 host must be in brackets; an IPv6 local address may be in brackets. If the text
/// has another form, a repeated link or more than kMaxLinks links, sets `error` and returns
/// nothing.
std::optional<std::vector<BondAddress>> ParseBondAddresses(const std::string& text,
                                                           std::string* error);

}  // namespace lidar::gst
