// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/scream_bench/frame_meter.h"

#include <algorithm>

#include "src/tools/scream_bench/frame_source.h"

namespace lidar::tools {
namespace {

/// Ages beyond this are those of a sender whose RTP timestamps are not Unix time.
constexpr Duration kPlausibleAge = std::chrono::seconds{60};

Duration FromTicks(std::int32_t ticks) {
  return std::chrono::nanoseconds{std::int64_t{ticks} * 1'000'000'000 /
                                  FramePacketizer::kClockRate};
}

}  // namespace

std::optional<Duration> FrameMeter::OnPacket(const ReceivedPacket& packet) {
  const std::int64_t sequence = sequence_.Unwrap(packet.sequence);
  first_sequence_ = std::min(first_sequence_.value_or(sequence), sequence);
  ++packets_;
  ce_packets_ += packet.is_ce;
  received_ += packet.size;
  if (!packet.marker) return std::nullopt;
  const Duration age =
      FromTicks(SequenceDistance(RtpTimestamp(packet.unix_time), packet.timestamp)) - offset_;
  if (frames() == 0 && (age < Duration{0} || age > kPlausibleAge)) offset_ += age;
  if (is_relative() && age < Duration{0}) offset_ += age;  // a younger one
  const Duration shown = std::max(Duration{0}, frames() == 0 && is_relative() ? Duration{0} : age);
  ages_ms_.Add(Milliseconds(shown));
  return shown;
}

std::uint64_t FrameMeter::lost() const {
  if (!first_sequence_) return 0;
  const auto expected = static_cast<std::uint64_t>(*sequence_.newest() - *first_sequence_ + 1);
  return expected > packets_ ? expected - packets_ : 0;
}

}  // namespace lidar::tools
