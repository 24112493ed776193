// SPDX-License-Identifier: LGPL-2.1-or-later
// The few fields of RTP and RTCP that congestion control needs, and the RTCP BYE.
#pragma once
#include <gio/gio.h>
#include <gst/gst.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::gst {

struct RtpHeader {
  guint32 ssrc = 0;
  guint32 timestamp = 0;
  guint16 seq = 0;
  guint8 payload_type = 0;
  bool marker = false;
  gsize header_size = 12;  // CSRCs and extension included
};

/// Returns nothing if `buffer` is too short or of another version.
std::optional<RtpHeader> ReadRtpHeader(GstBuffer* buffer);

/// True for a datagram on an RTP port that is RTCP (RFC 5761: packet types 192 to 223).
bool IsRtcp(ByteView datagram);
bool IsRtcp(GstBuffer* datagram);

/// A compound of an empty receiver report and a BYE for `ssrcs` (at most 31 of them).
std::vector<std::uint8_t> BuildBye(const std::vector<guint32>& ssrcs);
/// The SSRCs that say goodbye in a compound RTCP datagram.
std::vector<guint32> ParseBye(ByteView datagram);

/// Never 0. A sender that cannot see a packet cannot make another of the same digest.
std::uint64_t DigestOf(ByteView packet);

/// Sender of the buffer, or NULL; the buffer owns it.
GSocketAddress* SourceOf(GstBuffer* buffer);

}  // namespace lidar::gst
