// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtcp/sender_report.h"

#include <algorithm>
#include <limits>

#include "src/base/byte_writer.h"
#include "src/rtcp/ccfb.h"

namespace lidar::rtcp {
namespace {

constexpr std::uint8_t kReceiverReport = 201;
constexpr std::uint8_t kApp = 204;
constexpr std::uint8_t kVersion = 1;         // subtype of the packet
constexpr std::uint32_t kName = 0x474c5352;  // "GLSR"
constexpr std::uint16_t kWords = 15;         // 32-bit words after the first one

std::uint32_t Saturate(double value) {
  constexpr double kMax = std::numeric_limits<std::uint32_t>::max();
  return value > 0 ? static_cast<std::uint32_t>(std::min(value, kMax)) : 0;
}
std::uint32_t ToWire(DataRate rate) { return Saturate(rate.bits_per_second()); }
std::uint32_t ToWire(DataSize size) { return Saturate(static_cast<double>(size.bytes())); }
std::uint32_t ToWire(Duration time) { return Saturate(static_cast<double>(time.count()) / 1e3); }

struct AppPacket {
  std::uint8_t version = 0;
  ByteReader rest;  // what follows the name
};

/// Returns the content of `packet` if it is an APP packet with our name, and sets `ssrc`.
std::optional<AppPacket> OpenApp(ByteView packet, std::uint32_t* ssrc) {
  ByteReader in(packet);
  const std::uint8_t first = in.U8();
  const bool is_app = in.U8() == kApp;
  in.Be16();
  *ssrc = in.Be32();
  const bool is_ours = in.Be32() == kName;
  // These packets have no padding.
  constexpr std::uint8_t kPadding = 0x20;
  if (!in.ok() || !is_app || !is_ours || (first & kPadding) != 0) return std::nullopt;
  return AppPacket{static_cast<std::uint8_t>(first & 0x1f), in};
}

std::optional<SenderReport> ParseOne(ByteView packet) {
  SenderReport r;
  auto app = OpenApp(packet, &r.ssrc);
  if (!app || app->version != kVersion) return std::nullopt;
  ByteReader& in = app->rest;
  const auto rate = [&] { return DataRate::BitsPerSecond(in.Be32()); };
  const auto size = [&] { return DataSize::Bytes(in.Be32()); };
  const auto time = [&] { return Duration(std::chrono::microseconds(in.Be32())); };
  r.time_ms = in.Be32();
  r.target_bitrate = rate();
  r.estimated_capacity = rate();
  r.sent_bitrate = rate();
  r.ref_wnd = size();
  r.bytes_in_flight = size();
  r.queue_delay = time();
  r.rtt = time();
  r.sender_queue_delay = time();
  r.packets_sent = in.Be32();
  r.packets_lost = in.Be32();
  r.packets_ce = in.Be32();
  r.packets_dropped = in.Be32();
  if (!in.ok()) return std::nullopt;
  return r;
}

}  // namespace

std::vector<std::uint8_t> BuildSenderReport(const SenderReport& r) {
  std::vector<std::uint8_t> out;
  ByteWriter w(&out);
  w.U8(0x80);
  w.U8(kReceiverReport);
  w.Be16(1);
  w.Be32(r.ssrc);
  w.U8(0x80 | kVersion);
  w.U8(kApp);
  w.Be16(kWords);
  w.Be32(r.ssrc);
  w.Be32(kName);
  w.Be32(r.time_ms);
  for (const DataRate rate : {r.target_bitrate, r.estimated_capacity, r.sent_bitrate})
    w.Be32(ToWire(rate));
  for (const DataSize size : {r.ref_wnd, r.bytes_in_flight}) w.Be32(ToWire(size));
  for (const Duration time : {r.queue_delay, r.rtt, r.sender_queue_delay}) w.Be32(ToWire(time));
  for (const std::uint32_t n : {r.packets_sent, r.packets_lost, r.packets_ce, r.packets_dropped})
    w.Be32(n);
  return out;
}

bool HasSenderReport(ByteView datagram) {
  const auto packets = SplitRtcp(datagram);
  std::uint32_t ssrc = 0;
  return std::any_of(packets.begin(), packets.end(),
                     [&](ByteView packet) { return OpenApp(packet, &ssrc).has_value(); });
}

std::optional<SenderReport> ParseSenderReport(ByteView datagram) {
  for (const ByteView packet : SplitRtcp(datagram))
    if (const auto report = ParseOne(packet)) return report;
  return std::nullopt;
}

}  // namespace lidar::rtcp
