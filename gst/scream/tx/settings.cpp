// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/settings.h"

#include "gst/common/enum_type.h"

namespace lidar::gst {
namespace {

constexpr gdouble kMaxBps = 4294967295.0;
constexpr gdouble kMaxDelay = 60e9;
constexpr gint kLive = GST_PARAM_MUTABLE_PLAYING;

using scream::Extensions;
using scream::Parameters;
template <auto field>
constexpr auto P = At<&TxSettings::parameters, field>;
template <auto field>
constexpr auto X = At<&TxSettings::parameters, &Parameters::extensions, field>;

scream::Ecn ToEcn(gint mode) {
  switch (mode) {
    case kEcnEct0:
      return scream::Ecn::kEct0;
    case kEcnEct1:
      return scream::Ecn::kEct1;
    default:
      return scream::Ecn::kNotEct;
  }
}

}  // namespace

GType EcnModeType() {
  static const GEnumValue values[] = {{kEcnOff, "Not ECN-capable", "off"},
                                      {kEcnEct0, "Classic ECN, ECT(0)", "ect0"},
                                      {kEcnEct1, "L4S, ECT(1)", "ect1"},
                                      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarScreamEcnMode", values);
  return type;
}

const TxPadProperties& TxPadPropertyTable() {
  using S = TxPadSettings;
  static const TxPadProperties table = {{
      {"priority", "Weight of this pad's share of the bitrate", &S::priority, 0.01, 100, kLive},
      {"min-bitrate", "Lowest target, IP included; 0 takes the element's [bit/s]", &S::min_bps, 0,
       kMaxBps, kLive},
      {"start-bitrate", "First target, IP included; 0 takes the element's [bit/s]", &S::start_bps,
       0, kMaxBps, kLive},
      {"max-bitrate", "Highest target, IP included; 0 takes the element's [bit/s]", &S::max_bps, 0,
       kMaxBps, kLive},
      {"strict-priority",
       "Goes before all pads without, and gets its maximum before they get more than they need",
       &S::strict, 0, 0, kLive},
  }};
  return table;
}

const TxProperties& TxPropertyTable() {
  using S = TxSettings;
  static const TxProperties table = {{
      {"min-bitrate", "Lowest target of a pad without its own, IP included [bit/s]", &S::min_bps, 1,
       kMaxBps, kLive},
      {"start-bitrate", "First target of a pad without its own, IP included [bit/s]", &S::start_bps,
       1, kMaxBps, kLive},
      {"max-bitrate", "Highest target of a pad without its own, IP included [bit/s]", &S::max_bps,
       1, kMaxBps, kLive},
      {"max-total-bitrate",
       "Highest target of all pads together, IP included; 0: what the pads may have [bit/s]",
       &S::max_total_bps, 0, kMaxBps},
      {"ecn-mode", "ECN codepoint of sent packets; ect1 also selects the L4S reaction",
       EnumField<S>{&S::ecn_mode, EcnModeType}},
      {"max-queue-delay",
       "Live input older than this, half as much again in a gap of the link, is dropped in whole "
       "frames; other input waits [ns]",
       P<&Parameters::max_queue_delay>, 1e6, kMaxDelay},
      {"feedback-interval",
       "How seldom a healthy receiver may report; above 0 it reports at the end of frames [ns]",
       P<&Parameters::feedback_interval>, 0, kMaxDelay},
      {"stats-interval", "Time between element messages with the statistics; 0 for none [ns]",
       &S::stats_interval, 0, static_cast<gdouble>(G_MAXINT64), kLive},
      {"packet-overhead", "UDP and IP header of a packet on the wire [bytes]", &S::packet_overhead,
       0, 1000, kLive},
      {"send-bye", "Send an RTCP BYE on the src pad before EOS", &S::send_bye, 0, 0, kLive},
      {"sender-report-interval",
       "Time between reports to the receiver of how the sender sees the path, as RTCP on the src "
       "pad; 100 ms at least, 0 for none [ns]",
       &S::report_interval, 0, kMaxDelay, kLive},
      {"key-unit-on-loss",
       "Ask a video encoder for a key frame also when the network lost packets, not only when the "
       "queue dropped some",
       &S::key_unit_on_loss, 0, 0, kLive},
      {"pure-draft", "Exactly the draft: its constants, no optional part, no extension",
       &S::pure_draft},
      {"qdelay-target-lo", "QDELAY_TARGET_LO [ns]", P<&Parameters::qdelay_target_lo>, 1e6,
       kMaxDelay},
      {"min-ref-wnd", "MIN_REF_WND [bytes]", P<&Parameters::min_ref_wnd>, 100, 1e6},
      {"bytes-in-flight-head-room", "BYTES_IN_FLIGHT_HEAD_ROOM",
       P<&Parameters::bytes_in_flight_head_room>, 1, 10},
      {"beta-loss", "BETA_LOSS: window scale on loss", P<&Parameters::beta_loss>, 0.1, 1},
      {"beta-ecn", "BETA_ECN: window scale on classic CE", P<&Parameters::beta_ecn>, 0.1, 1},
      {"mss", "MSS: largest packet [bytes]", P<&Parameters::mss>, 100, 65535},
      {"post-congestion-delay-rtt", "POST_CONGESTION_DELAY_RTT [round trips]",
       P<&Parameters::post_congestion_delay_rtt>, 0, 10000},
      {"mul-increase-factor", "MUL_INCREASE_FACTOR", P<&Parameters::mul_increase_factor>, 0, 1},
      {"virtual-rtt", "VIRTUAL_RTT [ns]", P<&Parameters::virtual_rtt>, 1e6, kMaxDelay},
      {"l4s-avg-g-up", "L4S_AVG_G_UP", P<&Parameters::l4s_avg_g_up>, 0, 1},
      {"l4s-avg-g-down", "L4S_AVG_G_DOWN", P<&Parameters::l4s_avg_g_down>, 0, 1},
      {"ref-wnd-overhead-min", "REF_WND_OVERHEAD_MIN", P<&Parameters::ref_wnd_overhead_min>, 1, 10},
      {"ref-wnd-overhead-max", "REF_WND_OVERHEAD_MAX", P<&Parameters::ref_wnd_overhead_max>, 1, 20},
      {"rate-pace-min", "RATE_PACE_MIN [bit/s]", P<&Parameters::rate_pace_min>, 1000, kMaxBps},
      {"packet-pacing-headroom", "PACKET_PACING_HEADROOM", P<&Parameters::packet_pacing_headroom>,
       1, 10},
      {"max-relaxed-pacing-factor", "MAX_RELAXED_PACING_FACTOR",
       P<&Parameters::max_relaxed_pacing_factor>, 1, 100},
      {"relaxed-pacing-limit-low", "RELAXED_PACING_LIMIT_LOW",
       P<&Parameters::relaxed_pacing_limit_low>, 0, 1},
      {"rate-adjust-gain", "RATE_ADJUST_GAIN", P<&Parameters::rate_adjust_gain>, 0, 1},
      {"target-rate-divisor", "Divisor of window over round trip that gives the target",
       P<&Parameters::target_rate_divisor>, 1, 4},
      {"reduce-jitter", "Optional part: smaller window where the delay jitters",
       P<&Parameters::reduce_jitter>},
      {"clock-drift", "Optional part: follow the drift between the clocks",
       P<&Parameters::clock_drift>},
      {"link-layer-loss", "Optional part: tolerate losses of the link layer",
       P<&Parameters::link_layer_loss>},
      {"undershoot-remedy", "Optional part: back off less where the encoder undershoots",
       P<&Parameters::undershoot_remedy>},
      {"fast-start", "Beyond the draft: grow by what was acknowledged until congestion shows",
       X<&Extensions::fast_start>},
      {"drop-response", "Beyond the draft: follow a capacity drop within one round trip",
       X<&Extensions::drop_response>},
      {"bounded-flight", "Beyond the draft: bytes in flight stay near the window under marking",
       X<&Extensions::bounded_flight>},
      {"isolated-loss", "Beyond the draft: do not obey loss without other signs of congestion",
       X<&Extensions::isolated_loss>},
      {"quick-drain", "Beyond the draft: a backlog leaves at the window's rate after a drop",
       X<&Extensions::quick_drain>},
      {"answered-signals",
       "Beyond the draft: signs of congestion from before a reduction are not obeyed again",
       X<&Extensions::answered_signals>},
      {"even-alpha", "Beyond the draft: the marked fraction is averaged evenly over rounds",
       X<&Extensions::even_alpha>},
      {"adaptive-pacing", "Beyond the draft: pacing headroom follows the frame period",
       X<&Extensions::adaptive_pacing>},
      {"feedback-timeout", "Beyond the draft: the window decays without feedback",
       X<&Extensions::feedback_timeout>},
      {"gap-recovery", "Beyond the draft: after a gap of the link the window is what it was before",
       X<&Extensions::gap_recovery>},
      {"needed-floor",
       "Beyond the draft: encoders are asked for what their bounds need while the path lives",
       X<&Extensions::needed_floor>},
      {"classic-ecn", "Beyond the draft: find queues that mark ECT(1) like ECT(0), and react so",
       X<&Extensions::classic_ecn>},
  }};
  return table;
}

scream::Parameters ToParameters(const TxSettings& s) {
  scream::Parameters p = s.pure_draft ? scream::Parameters::Draft() : s.parameters;
  p.ecn = ToEcn(s.ecn_mode);
  p.max_queue_delay = s.max_queue_delay();
  p.feedback_interval = s.parameters.feedback_interval;
  if (s.max_total_bps > 0) p.max_total_bitrate = DataRate::BitsPerSecond(s.max_total_bps);
  return p;
}

}  // namespace lidar::gst
