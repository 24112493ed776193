// SPDX-License-Identifier: LGPL-2.1-or-later
// How the sender sees the path, told to the receiver among the media: RTCP APP (PT 204, name GLSR).
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {

/// On the wire everything is 32 bit: amounts saturate, counts wrap.
struct SenderReport {
  std::uint32_t ssrc = 0;
  std::uint32_t time_ms = 0;  // of a clock that only goes forward; any epoch, wraps
  DataRate target_bitrate;
  DataRate estimated_capacity;
  DataRate sent_bitrate;
  DataSize ref_wnd;
  DataSize bytes_in_flight;
  Duration queue_delay{};         // of the path; to 1 us, as are the other two
  Duration rtt{};                 // smoothed
  Duration sender_queue_delay{};  // until a packet leaves
  std::uint32_t packets_sent = 0;
  std::uint32_t packets_lost = 0;
  std::uint32_t packets_ce = 0;
  std::uint32_t packets_dropped = 0;  // by the sender
};

/// A compound of an empty receiver report and the APP packet.
std::vector<std::uint8_t> BuildSenderReport(const SenderReport& report);

/// True where a compound RTCP datagram holds such a packet, of whatever version.
bool HasSenderReport(ByteView datagram);
/// The first of its reports whose version is known and that is whole; none otherwise. What follows
/// the known fields is of newer senders, and passed over.
std::optional<SenderReport> ParseSenderReport(ByteView datagram);

}  // namespace lidar::scream
