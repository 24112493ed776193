// SPDX-License-Identifier: LGPL-2.1-or-later
// Passes RTP packets to a receiver: fragments, lost packets, streams that join late, and restarts
// of the sender. The input has for each packet 1 byte of flags, 1 byte of sequence step, 1 byte of
// time step [ms], 2 bytes of size, and the payload.
#include <vector>

#include "src/rtp/receiver.h"
#include "tests/fuzz/fuzz.h"

namespace {

using lidar::rtp::RtpPacket;

constexpr std::uint8_t kOtherSsrc = 1;
constexpr std::uint8_t kFixCrc = 2;
constexpr std::size_t kCrcOffset = 6;

/// Sets the correct length and CRC of a packet with a single unit, because a fuzzer does not find a
/// correct CRC by chance.
void FixCrc(std::vector<std::uint8_t>* payload) {
  if (payload->size() <= kCrcOffset + 4 || (*payload)[0] >> 5 != 0) return;
  const std::size_t header = lidar::rtp::HeaderSize(
      lidar::rtp::PacketType::kSingle, static_cast<lidar::rtp::UnitType>((*payload)[0] & 31));
  if (payload->size() <= header) return;
  const std::size_t length = payload->size() - header;
  for (std::size_t i = 0; i < 4; ++i)
    (*payload)[2 + i] = static_cast<std::uint8_t>(length >> (24 - 8 * i));
  const auto units = lidar::rtp::ParsePayload({payload->data(), payload->size()});
  if (units.size() != 1) return;
  const std::uint32_t crc = UnitCrc(units[0], units[0].body);
  for (std::size_t i = 0; i < 4; ++i)
    (*payload)[kCrcOffset + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lidar::rtp::Receiver receiver(std::chrono::milliseconds(50));
  lidar::ByteReader r(data, size);
  RtpPacket packet;
  std::uint64_t slices = 0;
  std::uint64_t packets = 0;
  while (r.ok() && r.remaining() > 0) {
    const std::uint8_t flags = r.U8();
    packet.ssrc = (flags & kOtherSsrc) != 0 ? 2 : 1;
    packet.sequence = static_cast<std::uint16_t>(packet.sequence + r.U8());
    packet.arrival += std::chrono::milliseconds(r.U8());
    packet.pts = packet.arrival;
    const std::size_t n = r.Be16();
    const auto body = r.Bytes(std::min(n, r.remaining()));
    std::vector<std::uint8_t> payload(body.begin(), body.end());
    if ((flags & kFixCrc) != 0) FixCrc(&payload);
    packet.payload = {payload.data(), payload.size()};
    ++packets;
    for (const auto& slice : receiver.Push(packet)) {
      ++slices;
      FUZZ_CHECK(slice.config != nullptr && !slice.bytes.empty());
      FUZZ_CHECK(slice.id.index < slice.id.count);
    }
  }
  receiver.Finish();
  const auto a = receiver.accounts();
  FUZZ_CHECK(a.packets_received == packets);
  // A new SSRC is a candidate at first. The receiver neither returns nor counts its slices until it
  // becomes the stream.
  FUZZ_CHECK(a.slices.slices_received == slices);
  FUZZ_CHECK(a.slices.slices_received >= a.slices.scans_complete);
  return 0;
}
