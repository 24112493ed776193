// SPDX-License-Identifier: LGPL-2.1-or-later
// Statistics of a controller.
#pragma once
#include <cstddef>
#include <cstdint>

#include "src/base/ecn.h"
#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {

/// How the path treats our ECN codepoint.
enum class EcnState {
  kOff,       ///< not requested
  kTesting,   ///< sent, result unknown
  kCapable,   ///< arrives as sent, or CE
  kBleached,  ///< arrives as Not-ECT; the sender has fallen back to Not-ECT
  kSilent,    ///< not acknowledged, unlike Not-ECT, to which the sender has fallen back
};
inline const char* ToString(EcnState state) {
  constexpr const char* kNames[] = {"off", "testing", "capable", "bleached", "silent"};
  return kNames[static_cast<std::size_t>(state)];
}

/// Reason for the target's last change, as a word for the `reason` of an event.
enum class RateReason { kStart, kIncrease, kCe, kLoss, kDelay, kDrop, kTimeout };
inline const char* ToString(RateReason reason) {
  constexpr const char* kNames[] = {"start", "increase",      "ce",         "loss",
                                    "delay", "capacity-drop", "no-feedback"};
  return kNames[static_cast<std::size_t>(reason)];
}

struct Statistics {
  // Network congestion control:
  DataSize ref_wnd;
  DataSize ref_wnd_i;
  DataSize bytes_in_flight;
  Duration s_rtt{};
  Duration min_rtt{};
  Duration qdelay{};
  Duration qdelay_avg{};
  Duration qdelay_target{};
  double l4s_alpha = 0;
  double ref_wnd_delay_scale = 1;
  double loss_rate = 0;
  double cross_traffic = 0;  ///< share of the link that others use; 0: none found
  // Rates with IP headers:
  DataRate target_bitrate;  ///< of all streams
  DataRate pace_bitrate;
  DataRate sent_bitrate;
  DataRate acked_bitrate;
  /// The capacity of the link, estimated from the spacing of packets that waited in its queue and
  /// from the acknowledged rate.
  DataRate estimated_capacity;
  // Sender's queue:
  DataSize queued;
  Duration media_qdelay{};
  // Counters:
  std::uint64_t packets_sent = 0;
  std::uint64_t packets_acked = 0;
  std::uint64_t packets_ce = 0;
  std::uint64_t packets_lost = 0;     ///< declared lost, even if they arrived later
  std::uint64_t packets_late = 0;     ///< declared lost, then acknowledged
  std::uint64_t packets_dropped = 0;  ///< dropped from the sender's queue
  DataSize bytes_sent;
  DataSize bytes_acked;
  std::uint64_t feedback_accepted = 0;
  std::uint64_t feedback_ignored = 0;  ///< implausible reports
  std::uint64_t foreign_blocks = 0;    ///< of unknown SSRCs
  std::uint64_t feedback_timeouts = 0;
  std::uint64_t loss_events = 0;
  std::uint64_t ce_events = 0;
  std::uint64_t delay_events = 0;
  std::uint64_t capacity_drops = 0;
  std::uint64_t gaps = 0;  ///< after which the window was restored
  std::uint64_t clock_resets = 0;
  EcnState ecn_state = EcnState::kOff;
  RateReason reason = RateReason::kStart;
};

struct StreamStatistics {
  DataRate target_bitrate;
  DataRate sent_bitrate;
  DataSize queued;
  Duration media_qdelay{};
  std::uint64_t packets_sent = 0;
  std::uint64_t packets_dropped = 0;
  std::uint64_t packets_lost = 0;
  std::uint64_t packets_ce = 0;
  DataSize bytes_sent;
};

}  // namespace lidar::scream
