// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/key_request.h"

#include "src/base/byte_writer.h"

namespace lidar::gst {
namespace {

constexpr std::uint8_t kVersionAndFormat = 0x81;  // version 2, no padding, PLI
constexpr std::uint8_t kPayloadFeedback = 206;
constexpr std::uint16_t kWords = 2;  // length in 32-bit words, minus one

}  // namespace

std::vector<std::uint8_t> BuildKeyRequest(std::uint32_t sender_ssrc, std::uint32_t media_ssrc) {
  std::vector<std::uint8_t> out;
  ByteWriter w(&out);
  w.U8(kVersionAndFormat);
  w.U8(kPayloadFeedback);
  w.Be16(kWords);
  w.Be32(sender_ssrc);
  w.Be32(media_ssrc);
  return out;
}

std::optional<std::uint32_t> ParseKeyRequest(ByteView rtcp_packet) {
  ByteReader in(rtcp_packet);
  const bool is_it =
      in.U8() == kVersionAndFormat && in.U8() == kPayloadFeedback && in.Be16() == kWords;
  in.Be32();
  const std::uint32_t media_ssrc = in.Be32();
  if (!is_it || !in.ok() || in.remaining() > 0) return std::nullopt;
  return media_ssrc;
}

}  // namespace lidar::gst
