// SPDX-License-Identifier: LGPL-2.1-or-later
// The RTCP packet Picture Loss Indication (RFC 4585, 6.3.1), by which a receiver requests a key
// unit: a slice that can be decoded without earlier slices.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::gst {

std::vector<std::uint8_t> BuildKeyRequest(std::uint32_t sender_ssrc, std::uint32_t media_ssrc);
/// Returns the SSRC from which `rtcp_packet` requests a key unit, or nothing if it is another kind
/// of packet.
std::optional<std::uint32_t> ParseKeyRequest(ByteView rtcp_packet);

}  // namespace lidar::gst
