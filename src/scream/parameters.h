// SPDX-License-Identifier: LGPL-2.1-or-later
// The constants of SCReAM v2 by the draft's names, and a switch for each extension of the draft.
#pragma once
#include "src/base/ecn.h"
#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {
using namespace std::chrono_literals;

/// The parts beyond the draft, which `docs/scream.md` explains. If all are off, the controller
/// follows the pure draft.
struct Extensions {
  /// Limits the window and the frames to the measured capacity, and reacts at once when the
  /// capacity falls.
  bool capacity = true;
  /// Reacts to each congestion only once, ignores isolated losses, and handles clocks that are set
  /// and callers that stall.
  bool evidence = true;
  /// Waits during a gap of the link, and continues with the window from before the gap.
  bool gaps = true;
  /// Makes the window as bold as those of other flows.
  bool company = true;
};

struct Parameters {
  /// Returns exactly the draft's constants. The draft's optional parts and the extensions are off.
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
  /// ref_wnd_i changes only if ref_wnd has grown by this factor since the last reduction (1.05 in
  /// the draft).
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

  // Extensions: fast growth, which the draft does not have, adds at most this fraction of the
  // acknowledged bytes to the window.
  double fast_increase_max = 0.5;
  /// The step by which fast growth increases with each round without congestion.
  double fast_increase_step = 0.03;
  /// The value of fast_increase_step if no marks give an early warning.
  double fast_increase_step_unmarked = 0.02;
  /// The number of rounds without congestion before fast growth begins. A queue of busy_qdelay
  /// stops fast growth.
  int fast_increase_rounds = 3;
  /// Slope of fast growth above the inflection point (8 in the draft).
  double fast_increase_slope = 3;
  /// The capacity counts as fallen if the target bitrate is at least this many times the measured
  /// capacity.
  double drop_threshold = 0.9;
  /// The value of drop_threshold if the measurement is unsure: it is shorter than both a frame
  /// period and VIRTUAL_RTT, fewer than half of its packets are marked, or the last reaction is
  /// recent.
  double drop_threshold_unsure = 1.5;
  /// A fall of the capacity on a path with marks must also lengthen the queue delay by this many
  /// packet gaps.
  double drop_growth = 3;
  /// The queue delay that shows a busy link. Without marks, it is busy_qdelay_unmarked times
  /// qdelay_target_lo.
  Duration busy_qdelay = 5ms;
  double busy_qdelay_unmarked = 0.45;
  /// The limit of bytes in flight, relative to ref_wnd, while the latest packets all come out of a
  /// queue.
  double bounded_overhead = 1.0;
  /// The limit of bytes in flight, relative to ref_wnd, on a path with marks but without a queue.
  double open_overhead = 1.2;
  /// The loss rate that is tolerated if the path carries ECT(1).
  double isolated_loss_threshold = 0.05;
  /// Losses show congestion if the queue delay is longer than this.
  Duration isolated_loss_qdelay = 6ms;
  /// The gain of the filter for l4s_alpha. The gain is 1/8 if alpha rises after two rounds in a row
  /// whose marked fraction is even_alpha_max or more. One round is enough if it is
  /// long_frame_period or longer.
  double even_alpha_g = 1.0 / 32;
  double even_alpha_max = 0.5;
  /// Pacing: the sending of a frame ends this long before its period ends. On a full link, each
  /// frame causes a queue of this length, which then drains.
  Duration pacing_reserve = 4ms;
  /// If marks work, the reserve is this fraction of the queue delay at which marking starts, but at
  /// least shortest_pacing_reserve and at most pacing_reserve.
  double onset_reserve = 0.8;
  Duration shortest_pacing_reserve = 700us;
  /// The reserve is between min_pacing_reserve and max_pacing_reserve, as fractions of a frame's
  /// period. If the period is shorter than long_frame_period, the lower limit is reduced in
  /// proportion.
  Duration long_frame_period = 50ms;
  double min_pacing_reserve = 0.18;
  double max_pacing_reserve = 0.35;

  /// Company: the growth near the inflection point, in MSS per round trip, for a flow that has less
  /// than its share and gets no marks. The value corresponds to a segment of 1500 bytes.
  double classic_growth = 1.5;
  /// The growth near the inflection point if the bottleneck starts to mark early.
  double early_growth = 0.45;
  /// The fraction of the draft's reaction to marks, for a flow that has less than its share, or if
  /// the bottleneck starts to mark early.
  double prague_backoff = 0.1;
  /// The time by which packets are sent sooner or later than at even intervals, so that their
  /// arrivals show the packets of other flows.
  Duration pacing_ripple = 300us;
  /// The fraction of fast growth that remains if losses occur at a full queue, which other flows
  /// may also fill.
  double fast_increase_beside = 0.2;
  /// The target during a gap, relative to the rate of the window. It is lower, because data that
  /// are queued during a gap may be late.
  double stall_share = 0.6;
  /// The time in which a lowered target removes a backlog.
  Duration backlog_drain = 200ms;
  /// The longest delay of a packet that the pacer catches up. The draft's pacing has no such term.
  Duration pacing_catch_up = 4ms;

  /// The limit for the bitrate of all streams together. Minimum bitrates take precedence over this
  /// limit.
  DataRate max_total_bitrate = DataRate::Infinite();
  /// Age at which packets in the sender's queue are late (see Controller::LatePackets()).
  Duration max_queue_delay = 200ms;
  /// Packets are dropped at once if they would be late even on a link that is faster by this
  /// factor.
  double link_may_be_faster = 1.5;
  /// The longest interval between the reports of a healthy receiver. If it is above 0, the receiver
  /// reports at the end of frames.
  Duration feedback_interval{0};

  Extensions extensions;
};

}  // namespace lidar::scream
