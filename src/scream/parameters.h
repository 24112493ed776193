// SPDX-License-Identifier: LGPL-2.1-or-later
// The constants of SCReAM v2 under the draft's names, and a switch for each part beyond the draft.
#pragma once
#include "src/base/time.h"
#include "src/base/units.h"
#include "src/scream/ecn.h"

namespace lidar::scream {
using namespace std::chrono_literals;

/// What the draft does not have, in four parts. `docs/scream.md` argues each; all off is the pure
/// draft.
struct Extensions {
  /// The window grows up to what the link is measured to carry, frames leave no faster, and a fall
  /// of the capacity is answered at once.
  bool capacity = true;
  /// A sign of congestion is answered once, a lone loss is no sign, and clocks that are set and
  /// callers that stand still are noticed.
  bool evidence = true;
  /// A gap of the link is sat out, and left with the window that it was met with.
  bool gaps = true;
  /// Beside other flows the window is as bold as theirs.
  bool company = true;
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
  /// Growth beyond the draft's is by this fraction of the acknowledged bytes at most...
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
  /// A fall of the capacity: a target above this part of the measured capacity shows a drop...
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
  /// Bytes in flight over ref_wnd while most packets come back marked.
  double bounded_overhead = 1.0;
  /// ...and while they do not.
  double open_overhead = 1.2;
  /// Tolerated loss rate where the path carries ECT(1)...
  double isolated_loss_threshold = 0.05;
  /// ...unless the packets around the loss waited as long as this.
  Duration isolated_loss_qdelay = 6ms;
  /// The factor of l4s_alpha's filter. Alpha attacks as the draft's does once two rounds in a row
  /// have this fraction; one is enough where it takes long_frame_period or more.
  double even_alpha_g = 1.0 / 32;
  double even_alpha_max = 0.5;
  /// Pacing: a frame leaves so much sooner than its period ends, but within these
  /// fractions of it. As much queue comes and goes with each frame where the link is full.
  Duration pacing_reserve = 4ms;
  /// Where marks work, this part of the queue at which marking begins, if that is less...
  double onset_reserve = 0.8;
  Duration shortest_pacing_reserve = 700us;
  /// ...and less still for frames more often than this.
  Duration long_frame_period = 50ms;
  double min_pacing_reserve = 0.18;
  double max_pacing_reserve = 0.35;

  /// Beside others: part of the draft's growth near the inflection point beside others that have
  /// more, where nothing marks, which is a segment of 1500 bytes a round trip...
  double classic_growth = 1.5;
  /// ...where marking begins early...
  double early_growth = 0.45;
  /// ...and part of the draft's reaction to marks, in either case.
  double prague_backoff = 0.1;
  /// Packets leave so much sooner and later than evenly, which shows what others send.
  Duration pacing_ripple = 300us;
  /// The part of its growth, where losses keep to a full queue that others fill, too.
  double fast_increase_beside = 0.2;
  /// The target in a gap, as a part of what the window allows: what is queued then may be late.
  double stall_share = 0.6;
  /// The time in which a backlog is to be gone, by a lower target.
  Duration backlog_drain = 200ms;
  /// So much of a late wake-up is caught up (the draft's pacing has no such term).
  Duration pacing_catch_up = 4ms;
  /// A little more than what is needed, as encoders round.
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
