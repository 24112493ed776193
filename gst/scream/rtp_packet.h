// SPDX-License-Identifier: LGPL-2.1-or-later
// The fields of RTP and RTCP that congestion control needs, and the RTCP BYE.
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
  gsize header_size = 12;  // with CSRCs and extension
};

/// Returns nothing if `buffer` is too short or of another version.
std::optional<RtpHeader> ReadRtpHeader(GstBuffer* buffer);

/// Returns true if a datagram on an RTP port is RTCP (RFC 5761: packet types 192 to 223).
bool IsRtcp(ByteView datagram);
bool IsRtcp(GstBuffer* datagram);
/// Returns true if a datagram on an RTP port is DTLS (RFC 7983: a first byte from 20 to 63).
bool IsDtls(GstBuffer* datagram);

/// Builds an empty receiver report and a BYE for `ssrcs`, at most 31 of them.
std::vector<std::uint8_t> BuildBye(const std::vector<guint32>& ssrcs);
/// Returns the SSRCs of all BYEs in a compound RTCP datagram.
std::vector<guint32> ParseBye(ByteView datagram);

/// Returns a digest, never 0. A sender that has not seen the packet cannot produce its digest.
std::uint64_t DigestOf(ByteView packet);

/// Returns the sender of the buffer, owned by the buffer, or NULL.
GSocketAddress* SourceOf(GstBuffer* buffer);

}  // namespace lidar::gst
