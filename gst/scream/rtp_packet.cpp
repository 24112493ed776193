// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/rtp_packet.h"

#include <gst/net/gstnetaddressmeta.h>

#include <algorithm>

#include "src/base/byte_writer.h"
#include "src/rtcp/ccfb.h"

namespace lidar::gst {
namespace {

constexpr gsize kFixedHeader = 12;
constexpr guint8 kReceiverReport = 201;
constexpr guint8 kBye = 203;
constexpr std::size_t kMaxSources = 31;

/// Returns the size of the header extension at `offset`, or nothing if the buffer is too short.
std::optional<gsize> ExtensionSize(GstBuffer* buffer, gsize offset) {
  guint8 raw[4];
  if (gst_buffer_extract(buffer, offset, raw, sizeof raw) != sizeof raw) return std::nullopt;
  return 4 + 4 * gsize{static_cast<guint16>(raw[2] << 8 | raw[3])};
}

}  // namespace

std::optional<RtpHeader> ReadRtpHeader(GstBuffer* buffer) {
  guint8 raw[kFixedHeader];
  if (gst_buffer_extract(buffer, 0, raw, sizeof raw) != sizeof raw || raw[0] >> 6 != 2)
    return std::nullopt;
  ByteReader in(raw, sizeof raw);
  const guint8 first = in.U8();
  const guint8 second = in.U8();
  RtpHeader h;
  h.marker = (second & 0x80) != 0;
  h.payload_type = second & 0x7f;
  h.seq = in.Be16();
  h.timestamp = in.Be32();
  h.ssrc = in.Be32();
  h.header_size = kFixedHeader + 4 * gsize{static_cast<guint8>(first & 0x0f)};
  if ((first & 0x10) != 0) {
    const auto extension = ExtensionSize(buffer, h.header_size);
    if (!extension) return std::nullopt;
    h.header_size += *extension;
  }
  if (h.header_size > gst_buffer_get_size(buffer)) return std::nullopt;
  return h;
}

bool IsRtcp(ByteView datagram) {
  return datagram.size >= 8 && datagram.data[0] >> 6 == 2 && datagram.data[1] >= 192 &&
         datagram.data[1] <= 223;
}

bool IsDtls(GstBuffer* datagram) {
  guint8 first = 0;
  gst_buffer_extract(datagram, 0, &first, 1);
  return first >= 20 && first <= 63;
}

bool IsRtcp(GstBuffer* datagram) {
  guint8 head[8];
  return gst_buffer_extract(datagram, 0, head, sizeof head) == sizeof head &&
         IsRtcp(ByteView{head, sizeof head});
}

std::vector<std::uint8_t> BuildBye(const std::vector<guint32>& ssrcs) {
  std::vector<std::uint8_t> out;
  if (ssrcs.empty()) return out;
  const std::size_t n = std::min(ssrcs.size(), kMaxSources);
  ByteWriter w(&out);
  w.U8(0x80);
  w.U8(kReceiverReport);
  w.Be16(1);
  w.Be32(ssrcs.front());
  w.U8(static_cast<std::uint8_t>(0x80 | n));
  w.U8(kBye);
  w.Be16(static_cast<std::uint16_t>(n));
  for (std::size_t i = 0; i < n; ++i) w.Be32(ssrcs[i]);
  return out;
}

std::vector<guint32> ParseBye(ByteView datagram) {
  std::vector<guint32> ssrcs;
  for (const ByteView packet : rtcp::SplitRtcp(datagram)) {
    ByteReader in(packet);
    const std::uint8_t first = in.U8();
    if (in.U8() != kBye) continue;
    in.Be16();
    for (int i = 0; i < (first & 0x1f); ++i) {
      const guint32 ssrc = in.Be32();
      if (in.ok()) ssrcs.push_back(ssrc);
    }
  }
  return ssrcs;
}

std::uint64_t DigestOf(ByteView packet) {
  std::uint64_t digest = 14695981039346656037U;  // FNV-1a
  for (const std::uint8_t byte : packet) digest = (digest ^ byte) * 1099511628211U;
  return digest | 1;
}

GSocketAddress* SourceOf(GstBuffer* buffer) {
  const GstNetAddressMeta* meta = gst_buffer_get_net_address_meta(buffer);
  return meta == nullptr ? nullptr : meta->addr;
}

}  // namespace lidar::gst
