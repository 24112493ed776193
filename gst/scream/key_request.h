// SPDX-License-Identifier: LGPL-2.1-or-later
// Picture Loss Indication (RFC 4585, 6.3.1): the receiver asks for a slice that stands alone.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::gst {

std::vector<std::uint8_t> BuildKeyRequest(std::uint32_t sender_ssrc, std::uint32_t media_ssrc);
/// Returns the SSRC of which an RTCP packet requests a key unit, or nothing for other packets.
std::optional<std::uint32_t> ParseKeyRequest(ByteView rtcp_packet);

}  // namespace lidar::gst
