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
  gsize header_size = 12;  // including CSRCs and header extension
};

/// Reads the RTP header. Returns nothing if `buffer` is too short or its RTP version is not 2.
std::optional<RtpHeader> ReadRtpHeader(GstBuffer* buffer);

/// Returns true if the datagram is RTCP: its packet type is from 192 to 223 (RFC 5761).
bool IsRtcp(ByteView datagram);
bool IsRtcp(GstBuffer* datagram);
/// Returns true if the datagram is DTLS: its first byte is from 20 to 63 (RFC 7983).
bool IsDtls(GstBuffer* datagram);

/// Builds an RTCP datagram of an empty receiver report and a BYE. The BYE has the first 31 of
/// `ssrcs`.
std::vector<std::uint8_t> BuildBye(const std::vector<guint32>& ssrcs);
/// Returns the SSRCs of all BYEs in a compound RTCP datagram.
std::vector<guint32> ParseBye(ByteView datagram);

/// Returns a digest of `packet`, which is never 0. A sender that has not seen the packet cannot
/// send another one with this digest, except by chance.
std::uint64_t DigestOf(ByteView packet);

/// Returns the address from which the buffer was received, or NULL. The buffer owns the address.
GSocketAddress* SourceOf(GstBuffer* buffer);

}  // namespace lidar::gst
