// SPDX-License-Identifier: LGPL-2.1-or-later
// The constants of SCReAM v2 under the draft's names, and a switch for each part beyond the draft.
#pragma once
#include "src/base/time.h"
#include "src/base/units.h"
#include "src/scream/ecn.h"

namespace lidar::scream {
using namespace std::chrono_literals;

/// Parts that the draft does not have. `docs/scream.md` argues each; all off is the pure draft.
struct Extensions {
  /// Start-up grows the window by what was acknowledged until the first sign of congestion.
  bool fast_start = true;
  /// On a capacity drop the window follows the acknowledged rate within one round trip.
  bool drop_response = true;
  /// While packets come back marked, bytes in flight stay near the window.
  bool bounded_flight = true;
  /// Loss without marks, delay or a loss rate beyond random is repaired, not obeyed.
  bool isolated_loss = true;
  /// A backlog in the sender's queue leaves at the window's rate, and stops to hold the target down
  /// as soon as it is gone.
  bool quick_drain = true;
  /// Losses (and, after a capacity drop, marks) of packets that were on the way when the window
  /// was reduced for them are no new congestion.
  bool answered_signals = true;
  /// The fraction of marked packets is taken over a whole round and averaged evenly.
  bool even_alpha = true;
  /// Pacing headroom follows the frame period, so that a slow frame rate does not build a queue.
  bool adaptive_pacing = true;
  /// Without feedback the window decays to its minimum, and jumps back once the path returns.
  bool feedback_timeout = true;
  /// After a time in which the link carried next to nothing the window is what it was before.
  bool gap_recovery = true;
  /// What the streams need is asked of the encoders while the path gives a sign of life, whatever
  /// the window is; bytes in flight and pacing stay the window's.
  bool needed_floor = true;
  /// Marks of a queue that marks ECT(1) like ECT(0) have the reaction that it expects.
  bool classic_ecn = true;
  /// Clocks that were set and callers that stood still are noticed; where the bottleneck marks, the
  /// base delay is that of the last half minute.
  bool clock_care = true;
  /// Beside other flows, and where marking begins early, the window is as bold as theirs.
  bool shared_link = true;
};

struct Parameters {
  /// Exactly the draft's constants, its optional parts off and no extension.
  static Parameters Draft();

  /// Codepoint of sent packets; ECT(1) also selects the L4S reaction (the draft's IS_L4S).
  Ecn ecn = Ecn::kEct1;

  // Network congestion control
  Duration qdelay_target_lo = 60ms;
  DataSize min_ref_wnd = DataSize::Bytes(3000);
  double bytes_in_flight_head_room = 1.5;
  double beta_loss = 0.7;
  double beta_ecn = 0.8;
  DataSize mss = DataSize::Bytes(1000);
  double post_congestion_delay_rtt = 100;
  double mul_increase_factor = 0.02;
  Duration virtual_rtt = 25ms;
  double l4s_avg_g_up = 1.0 / 8;
  double l4s_avg_g_down = 1.0 / 128;
  double qdelay_avg_g = 1.0 / 4;

  // Optional: jitter scale
  bool reduce_jitter = true;
  double qdelay_min_max_avg_g = 1.0 / 16;
  double qdelay_dev_avg_g = 1.0 / 32;
  Duration qdelay_dev_threshold = 10ms;

  // Sender transmission control
  double ref_wnd_overhead_min = 1.5;
  double ref_wnd_overhead_max = 3.0;
  DataRate rate_pace_min = DataRate::BitsPerSecond(50e3);
  double packet_pacing_headroom = 1.5;
  double max_relaxed_pacing_factor = 4.0;
  double relaxed_pacing_limit_low = 0.8;

  // Media rate control
  DataSize packet_overhead = DataSize::Bytes(20);
  double rate_adjust_gain = 1.0 / 16;
  double frame_size_dev_alpha = 1.0 / 64;
  /// The fixed divisor of the target bitrate.
  double target_rate_divisor = 1.2;

  // Optional: clock drift
  bool clock_drift = true;
  double qdelay_min_avg_alpha = 1.0 / 256;

  // Optional: link-layer losses
  bool link_layer_loss = true;
  double loss_rate_threshold = 0.01;

  // Optional: undershoot
  bool undershoot_remedy = true;
  double acked_bitrate_margin = 0.8;
  double backoff_scale_low_target_rate = 0.25;

  // Extensions
  /// fast_start: growth by this fraction of the acknowledged bytes at most...
  double fast_increase_max = 0.5;
  /// ...reached by steps of this, one for each round without congestion...
  double fast_increase_step = 0.03;
  /// ...where marks give an early warning, else of this...
  double fast_increase_step_unmarked = 0.02;
  /// ...after so many rounds; a queue of this length stops it.
  int fast_increase_rounds = 3;
  Duration fast_increase_qdelay = 5ms;
  /// Slope of the growth above the inflection point (the draft's is 8).
  double fast_increase_slope = 3;
  /// drop_response: a target above this part of the measured capacity shows a drop...
  double drop_threshold = 0.9;
  /// ...or above this, where it was measured over less than a frame period and VIRTUAL_RTT, with
  /// fewer than half of the packets marked, or just after another reaction...
  double drop_threshold_unsure = 1.5;
  /// ...where marks work, only if the wait grew by so many gaps between packets meanwhile...
  double drop_growth = 3;
  /// ...after which the target is this fraction of it.
  double drop_beta = 0.9;
  /// A packet behind this much queue shows that the link is busy; without marks, this fraction of
  /// qdelay_target.
  Duration busy_qdelay = 5ms;
  double busy_qdelay_unmarked = 0.45;
  /// bounded_flight: bytes in flight over ref_wnd while most packets come back marked.
  double bounded_overhead = 1.0;
  /// ...and while they do not.
  double open_overhead = 1.2;
  /// isolated_loss: tolerated loss rate where the path carries ECT(1)...
  double isolated_loss_threshold = 0.05;
  /// ...unless the packets around the loss waited as long as this.
  Duration isolated_loss_qdelay = 6ms;
  /// even_alpha: the filter's factor. Alpha attacks as the draft's does once two rounds in a row
  /// have this fraction; one is enough where it takes long_frame_period or more.
  double even_alpha_g = 1.0 / 32;
  double even_alpha_max = 0.5;
  /// adaptive_pacing: a frame leaves so much sooner than its period ends, but within these
  /// fractions of it. As much queue comes and goes with each frame where the link is full.
  Duration pacing_reserve = 4ms;
  /// Where marks work, this part of the queue at which marking begins, if that is less...
  double onset_reserve = 0.9;
  Duration shortest_pacing_reserve = 700us;
  /// ...and less still for frames more often than this.
  Duration long_frame_period = 50ms;
  double min_pacing_reserve = 0.18;
  double max_pacing_reserve = 0.35;

  /// shared_link: part of the draft's growth near the inflection point beside others that have
  /// more, where nothing marks, which is a segment of 1500 bytes a round trip...
  double classic_growth = 1.5;
  /// ...where marking begins early...
  double early_growth = 0.45;
  /// ...and part of the draft's reaction to marks, in either case.
  double prague_backoff = 0.1;
  /// Packets leave so much sooner and later than evenly, which shows what others send.
  Duration pacing_ripple = 300us;
  /// fast_start: of its growth, where losses keep to a full queue that others fill, too.
  double fast_increase_beside = 0.2;
  /// gap_recovery: of what the window allows, the target in a gap: what is queued then may be late.
  double stall_share = 0.6;
  /// quick_drain: the time in which a backlog is to be gone, by a lower target.
  Duration backlog_drain = 200ms;
  /// So much of a late wake-up is caught up (the draft's pacing has no such term).
  Duration pacing_catch_up = 4ms;
  /// needed_floor: a little more than what is needed, as encoders round.
  double needed_margin = 1.03;

  /// All streams together get no more, but for their minima.
  DataRate max_total_bitrate = DataRate::Infinite();
  /// Packets older than this in the sender's queue are late (see Controller::LatePackets).
  Duration max_queue_delay = 200ms;
  /// What would be late on a link so many times as fast as is known is given up at once.
  double link_may_be_faster = 1.5;
  /// How seldom a healthy receiver may report. Above 0 it reports at the end of frames.
  Duration feedback_interval{0};

  Extensions extensions;
};

}  // namespace lidar::scream
