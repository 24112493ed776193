// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtcp/ccfb.h"

#include <algorithm>

#include "src/base/byte_writer.h"

namespace lidar::rtcp {
namespace {

constexpr std::uint8_t kVersion2 = 0x80;
constexpr std::uint8_t kVersionMask = 0xC0;
constexpr std::uint8_t kPaddingBit = 0x20;
constexpr std::uint8_t kFormatMask = 0x1F;
constexpr std::uint8_t kFormatCcfb = 11;
constexpr std::uint8_t kTypeRtpfb = 205;
constexpr std::size_t kHeaderAndSender = 8;
constexpr std::size_t kTimestamp = 4;
constexpr std::uint16_t kOffsetMask = 0x1FFF;
constexpr std::uint16_t kOffsetSaturated = 0x1FFE;
constexpr double kOffsetUnitsPerSecond = 1024;

/// Returns the length of an RTCP packet as its header gives it, or 0 if the header is invalid.
std::size_t RtcpLength(ByteView bytes) {
  if (bytes.size < 4 || (bytes.data[0] & kVersionMask) != kVersion2) return 0;
  ByteReader reader(bytes.Sub(2));
  return 4 * (std::size_t{reader.Be16()} + 1);
}

/// Returns the packet without its RTCP padding, or an empty view if the padding is malformed.
ByteView WithoutPadding(ByteView packet) {
  if ((packet.data[0] & kPaddingBit) == 0) return packet;
  const std::size_t padding = packet.data[packet.size - 1];
  if (padding == 0 || padding % 4 != 0 || padding + kHeaderAndSender + kTimestamp > packet.size)
    return {};
  return packet.Sub(0, packet.size - padding);
}

PacketMetric ReadMetric(std::uint16_t bits) {
  PacketMetric m;
  m.received = (bits & 0x8000) != 0;
  m.ecn = static_cast<Ecn>(bits >> 13 & 3);
  const std::uint16_t offset = bits & kOffsetMask;
  if (offset < kOffsetSaturated) m.arrival_offset = FromSeconds(offset / kOffsetUnitsPerSecond);
  return m;
}

std::uint16_t MetricBits(const PacketMetric& m) {
  if (!m.received) return 0;
  unsigned offset = kOffsetMask;
  if (m.arrival_offset) {
    const double units = std::max(0.0, Seconds(*m.arrival_offset)) * kOffsetUnitsPerSecond + 0.5;
    offset = units >= kOffsetSaturated ? kOffsetSaturated : static_cast<unsigned>(units);
  }
  return static_cast<std::uint16_t>(0x8000U | static_cast<unsigned>(m.ecn) << 13 | offset);
}

struct ReadBlocks {
  std::vector<SsrcReport> blocks;
  bool padding_is_zero = true;
};

/// Reads all blocks, where `reading` is the meaning of num_reports. Returns nothing if the blocks
/// do not end where `bytes` ends.
std::optional<ReadBlocks> Read(ByteView bytes, NumReports reading) {
  ReadBlocks result;
  ByteReader reader(bytes);
  while (reader.remaining() > 0) {
    SsrcReport block;
    block.ssrc = reader.Be32();
    block.begin_seq = reader.Be16();
    const std::size_t field = reader.Be16();
    const std::size_t count = reading == NumReports::kCount ? field : field + 1;
    if (!reader.ok() || reader.remaining() < 2 * (count + count % 2)) return std::nullopt;
    block.metrics.reserve(count);
    for (std::size_t i = 0; i < count; ++i) block.metrics.push_back(ReadMetric(reader.Be16()));
    if (count % 2 != 0 && reader.Be16() != 0) result.padding_is_zero = false;
    result.blocks.push_back(std::move(block));
  }
  return result;
}

}  // namespace

bool IsCcfb(ByteView packet) {
  return packet.size >= 4 && (packet.data[0] & kVersionMask) == kVersion2 &&
         (packet.data[0] & kFormatMask) == kFormatCcfb && packet.data[1] == kTypeRtpfb;
}

std::vector<ByteView> SplitRtcp(ByteView datagram) {
  std::vector<ByteView> packets;
  for (std::size_t at = 0; at < datagram.size;) {
    const ByteView rest = datagram.Sub(at);
    const std::size_t length = RtcpLength(rest);
    if (length == 0 || length > rest.size) return {};
    packets.push_back(rest.Sub(0, length));
    at += length;
  }
  return packets;
}

std::optional<CongestionFeedback> CcfbParser::Parse(ByteView packet) {
  if (!IsCcfb(packet) || RtcpLength(packet) != packet.size) return std::nullopt;
  const ByteView body = WithoutPadding(packet);
  if (body.size < kHeaderAndSender + kTimestamp) return std::nullopt;
  CongestionFeedback feedback;
  feedback.sender_ssrc = ByteReader(body.Sub(4)).Be32();
  feedback.report_timestamp = ByteReader(body.Sub(body.size - kTimestamp)).Be32();
  const ByteView blocks = body.Sub(kHeaderAndSender, body.size - kHeaderAndSender - kTimestamp);
  auto count = Read(blocks, NumReports::kCount);
  auto minus_one = Read(blocks, NumReports::kCountMinusOne);
  if (!count && !minus_one) return std::nullopt;
  // The two meanings give different lengths for even counts only. For odd counts, the reference
  // implementation of SCReAM sends a metric block where RFC 8888 has padding.
  if (!count || (minus_one && !count->padding_is_zero))
    reading_ = NumReports::kCountMinusOne;
  else if (!minus_one)
    reading_ = NumReports::kCount;
  feedback.blocks =
      std::move(reading_ == NumReports::kCountMinusOne ? minus_one->blocks : count->blocks);
  return feedback;
}

std::vector<std::uint8_t> BuildCcfb(const CongestionFeedback& feedback, NumReports reading) {
  std::vector<std::uint8_t> bytes;
  ByteWriter writer(&bytes);
  writer.U8(kVersion2 | kFormatCcfb);
  writer.U8(kTypeRtpfb);
  writer.Be16(0);  // the length, filled in at the end
  writer.Be32(feedback.sender_ssrc);
  for (const SsrcReport& block : feedback.blocks) {
    if (block.metrics.empty()) continue;
    const std::size_t count = block.metrics.size();
    writer.Be32(block.ssrc);
    writer.Be16(block.begin_seq);
    writer.Be16(static_cast<std::uint16_t>(reading == NumReports::kCount ? count : count - 1));
    for (const PacketMetric& m : block.metrics) writer.Be16(MetricBits(m));
    if (count % 2 != 0) writer.Be16(0);
  }
  writer.Be32(feedback.report_timestamp);
  const std::size_t words = bytes.size() / 4 - 1;
  bytes[2] = static_cast<std::uint8_t>(words >> 8);
  bytes[3] = static_cast<std::uint8_t>(words);
  return bytes;
}

}  // namespace lidar::rtcp
