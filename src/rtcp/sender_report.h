// SPDX-License-Identifier: LGPL-2.1-or-later
// Reports to the receiver about the path as the sender sees it: RTCP APP (PT 204, name GLSR).
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::rtcp {

/// All fields have 32 bits in the packet. Amounts saturate, and counts wrap.
struct SenderReport {
  std::uint32_t ssrc = 0;
  std::uint32_t time_ms = 0;  // of a monotonic clock with any epoch; wraps
  DataRate target_bitrate;
  DataRate estimated_capacity;
  DataRate sent_bitrate;
  DataSize ref_wnd;
  DataSize bytes_in_flight;
  Duration queue_delay{};         // of the path; this and the next two fields are sent in us
  Duration rtt{};                 // smoothed
  Duration sender_queue_delay{};  // time that packets wait at the sender
  std::uint32_t packets_sent = 0;
  std::uint32_t packets_lost = 0;
  std::uint32_t packets_ce = 0;
  std::uint32_t packets_dropped = 0;  // dropped by the sender
};

/// Builds an empty receiver report and the APP packet.
std::vector<std::uint8_t> BuildSenderReport(const SenderReport& report);

/// Returns true if a compound RTCP datagram has an APP packet of this name, of any version.
bool HasSenderReport(ByteView datagram);
/// Parses the first sender report that is complete and has a known version. Newer senders may
/// append fields, which are ignored.
std::optional<SenderReport> ParseSenderReport(ByteView datagram);

}  // namespace lidar::rtcp
