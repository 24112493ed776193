// SPDX-License-Identifier: LGPL-2.1-or-later
// The constants of SCReAM v2 by the draft's names, and a switch for each extension of the draft.
#pragma once
#include "src/base/ecn.h"
#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {
using namespace std::chrono_literals;

/// The parts beyond the draft, which `docs/scream.md` explains. All off is the pure draft.
struct Extensions {
  /// Limits window and frames to the measured capacity, and reacts to its fall at once.
  bool capacity = true;
  /// Reacts to congestion once, ignores isolated losses, and handles set clocks and stalled
  /// callers.
  bool evidence = true;
  /// Waits through a gap of the link, and continues with the window from before it.
  bool gaps = true;
  /// Makes the window as bold as those of other flows.
  bool company = true;
};

struct Parameters {
  /// Returns exactly the draft's constants, without its optional parts and extensions.
  static Parameters Draft() {
    Parameters p;
    p.reduce_jitter = p.clock_drift = p.link_layer_loss = p.undershoot_remedy = false;
    p.extensions = {false, false, false, false};
    p.ref_wnd_i_update_growth = 1.05;
    p.pacing_catch_up = Duration{0};
    return p;
  }

  /// Codepoint of sent packets. ECT(1) also selects the L4S reaction (IS_L4S of the draft).
  Ecn ecn = Ecn::kEct1;

  // Network congestion control:
  Duration qdelay_target_lo = 60ms;
  DataSize min_ref_wnd = DataSize::Bytes(3000);
  double bytes_in_flight_head_room = 1.5;
  double beta_loss = 0.7;
  double beta_ecn = 0.8;
  DataSize mss = DataSize::Bytes(1000);
  double post_congestion_delay_rtt = 100;
  double mul_increase_factor = 0.02;
  Duration virtual_rtt = 25ms;
  double l4s_avg_g = 1.0 / 16;
  double qdelay_avg_g = 1.0 / 4;
  double ref_wnd_i_update_max_hold_rtts = 50;
  /// ref_wnd_i moves if ref_wnd has grown by this factor since the last reduction (draft: 1.05).
  double ref_wnd_i_update_growth = 1;

  // Optional, jitter scale:
  bool reduce_jitter = true;
  double qdelay_min_max_avg_g = 1.0 / 16;
  double qdelay_dev_avg_g = 1.0 / 32;
  Duration qdelay_dev_threshold = 10ms;

  // Sender transmission control:
  double ref_wnd_overhead_min = 1.5;
  double ref_wnd_overhead_max = 3.0;
  DataRate rate_pace_min = DataRate::BitsPerSecond(50e3);
  double packet_pacing_headroom = 1.5;
  double max_relaxed_pacing_factor = 4.0;
  double relaxed_pacing_limit_low = 0.8;

  // Media rate control:
  DataSize packet_overhead = DataSize::Bytes(20);
  double rate_adjust_gain = 1.0 / 16;
  double frame_size_dev_alpha = 1.0 / 64;
  /// Fixed divisor of the target bitrate.
  double target_rate_divisor = 1.2;

  // Optional, clock drift:
  bool clock_drift = true;
  double qdelay_min_avg_alpha = 1.0 / 256;

  // Optional, link-layer losses:
  bool link_layer_loss = true;
  double loss_rate_threshold = 0.01;

  // Optional, undershoot:
  bool undershoot_remedy = true;
  double acked_bitrate_margin = 0.8;
  double backoff_scale_low_target_rate = 0.25;

  // Extensions: fast growth, beyond the draft's, adds at most this part of the acknowledged bytes.
  double fast_increase_max = 0.5;
  /// Step by which fast growth increases with each round without congestion.
  double fast_increase_step = 0.03;
  /// fast_increase_step if no marks give an early warning.
  double fast_increase_step_unmarked = 0.02;
  /// Rounds without congestion before fast growth begins. A queue of busy_qdelay stops it.
  int fast_increase_rounds = 3;
  /// Slope of fast growth above the inflection point (8 in the draft).
  double fast_increase_slope = 3;
  /// The capacity has fallen if the target is above this part of its measured value.
  double drop_threshold = 0.9;
  /// drop_threshold for an unsure measurement: shorter than both a frame period and VIRTUAL_RTT,
  /// with fewer than half of the packets marked, or shortly after another reaction.
  double drop_threshold_unsure = 1.5;
  /// A fall on a path with marks must also lengthen the queue delay by this many packet gaps.
  double drop_growth = 3;
  /// Queue delay that shows a busy link. Without marks it is a part of qdelay_target.
  Duration busy_qdelay = 5ms;
  double busy_qdelay_unmarked = 0.45;
  /// Limit of bytes in flight relative to ref_wnd while packets keep coming out of a queue.
  double bounded_overhead = 1.0;
  /// The same limit on a path with marks, without such a queue.
  double open_overhead = 1.2;
  /// Tolerated loss rate if the path carries ECT(1).
  double isolated_loss_threshold = 0.05;
  /// Losses show congestion if the queue delays packets by more than this.
  Duration isolated_loss_qdelay = 6ms;
  /// Gain of l4s_alpha's filter. The gain is 1/8 while alpha rises after two rounds in a row with a
  /// marked part of even_alpha_max or more, or after one such round of at least long_frame_period.
  double even_alpha_g = 1.0 / 32;
  double even_alpha_max = 0.5;
  /// Pacing: a frame has left this long before its period ends. On a full link a queue of this
  /// length comes and goes with each frame.
  Duration pacing_reserve = 4ms;
  /// If marks work, the reserve is this part of the queue delay at which marking starts, but at
  /// least shortest_pacing_reserve and at most pacing_reserve.
  double onset_reserve = 0.8;
  Duration shortest_pacing_reserve = 700us;
  /// min_pacing_reserve and max_pacing_reserve are fractions of a frame's period. Below this
  /// period, the least reserve is smaller in proportion.
  Duration long_frame_period = 50ms;
  double min_pacing_reserve = 0.18;
  double max_pacing_reserve = 0.35;

  /// Company: growth near the inflection point, in MSS a round trip, for a flow with less than its
  /// share and without marks. The value is a segment of 1500 bytes.
  double classic_growth = 1.5;
  /// The same growth if marking starts early.
  double early_growth = 0.45;
  /// Part of the draft's reaction to marks, for a flow with less than its share or if marking
  /// starts early.
  double prague_backoff = 0.1;
  /// Packets leave by this much sooner or later than at even intervals, so that arrivals show other
  /// flows' packets.
  Duration pacing_ripple = 300us;
  /// Part of fast growth that is left if losses occur at a full queue, which other flows may also
  /// fill.
  double fast_increase_beside = 0.2;
  /// Target in a gap, relative to the window's rate: data queued in a gap may be late.
  double stall_share = 0.6;
  /// Time in which a lower target removes a backlog.
  Duration backlog_drain = 200ms;
  /// Longest part of a late wake-up that is caught up. The draft's pacing has no such term.
  Duration pacing_catch_up = 4ms;

  /// Limit for all streams together; minimum bitrates take precedence.
  DataRate max_total_bitrate = DataRate::Infinite();
  /// Age at which packets in the sender's queue are late (see Controller::LatePackets()).
  Duration max_queue_delay = 200ms;
  /// Packets are dropped at once if they would be late even on a link this many times as fast.
  double link_may_be_faster = 1.5;
  /// Longest interval of a healthy receiver's reports. Above 0 the receiver reports at the end of
  /// frames.
  Duration feedback_interval{0};

  Extensions extensions;
};

}  // namespace lidar::scream
