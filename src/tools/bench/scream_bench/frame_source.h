// SPDX-License-Identifier: LGPL-2.1-or-later
// A media source whose bitrate follows the target exactly. It makes frames of RTP packets.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <random>

#include "gst/common/refs.h"
#include "src/base/units.h"
#include "src/tools/bench/scream_bench/options.h"

namespace lidar::tools {

/// Computes the sizes of frames. Their sum follows the bitrate despite rounding and jitter.
class FrameSizes {
 public:
  FrameSizes(double fps, double jitter_percent)
      : period_(FromSeconds(1 / fps)), jitter_(jitter_percent / 100) {}

  /// Returns the size of the next frame's payload.
  DataSize Next(DataRate rate);
  Duration period() const { return period_; }

 private:
  Duration period_;
  double jitter_;
  double carry_bytes_ = 0;
  std::minstd_rand random_;  // without a seed, so that every run has the same frames
};

/// Divides frames into the RTP packets of one stream, which has SSRC 100, payload type 96 and
/// sequence numbers from 0.
class FramePacketizer {
 public:
  static constexpr std::uint32_t kSsrc = 100;
  static constexpr std::uint8_t kPayloadType = 96;
  static constexpr std::uint32_t kClockRate = 90'000;

  explicit FramePacketizer(std::uint32_t mtu) : mtu_(mtu) {}

  /// Returns packets with `payload` bytes in all, or none for an empty frame. The last packet has
  /// the marker. The RTP timestamp is computed from `created`, which is a Unix time.
  gst::BufferListPtr Packetize(DataSize payload, Duration created, GstClockTime pts);

 private:
  std::uint32_t mtu_;
  std::uint16_t next_sequence_ = 0;
};

/// Converts a Unix time to an RTP timestamp (90 kHz).
inline std::uint32_t RtpTimestamp(Duration unix_time) {
  constexpr std::int64_t kBillion = 1'000'000'000;
  const std::int64_t s = unix_time.count() / kBillion;
  const std::int64_t ns = unix_time.count() % kBillion;
  return static_cast<std::uint32_t>(s * FramePacketizer::kClockRate +
                                    ns * FramePacketizer::kClockRate / kBillion);
}

}  // namespace lidar::tools
