// SPDX-License-Identifier: LGPL-2.1-or-later
// Transport-wide congestion control feedback (RTCP PT 205, FMT 15), as WebRTC speaks it:
// draft-holmer-rmcat-transport-wide-cc-extensions-01.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/time.h"

namespace lidar::scream {

/// The URI of the RTP header extension that numbers the packets.
constexpr const char* kTwccUri =
    "http://www.ietf.org/id/draft-holmer-rmcat-transport-wide-cc-extensions-01";
/// Arrivals are whole multiples of this.
constexpr Duration kTwccTick = std::chrono::microseconds(250);
/// They repeat after this, 12 days.
constexpr Duration kTwccPeriod = std::chrono::milliseconds(64) * (1 << 24);
/// Longer reports are refused: half of the numbers are the most that could be told apart.
constexpr std::size_t kMaxTwccPackets = 1 << 14;

struct TwccFeedback {
  std::uint32_t sender_ssrc = 0;
  std::uint32_t media_ssrc = 0;
  std::uint16_t base_number = 0;
  std::uint8_t report_number = 0;
  /// Of base_number, base_number + 1, ...: arrival by the receiver's clock; none: not received.
  std::vector<std::optional<Duration>> arrivals;
};

/// True for one RTCP packet that claims to be such feedback (it may still not parse).
bool IsTwcc(ByteView rtcp_packet);
/// One RTCP packet, whole. Nothing for other types and versions, lengths that do not fit, and
/// reserved symbols.
std::optional<TwccFeedback> ParseTwcc(ByteView rtcp_packet);
/// Serialises; arrivals are rounded to the tick. Nothing where two arrivals lie too far apart for
/// the format (8 s), or there are too many packets, or none.
std::optional<std::vector<std::uint8_t>> BuildTwcc(const TwccFeedback& feedback);

}  // namespace lidar::scream
