// SPDX-License-Identifier: LGPL-2.1-or-later
// The properties of screamtx, of its pads, and what they mean to the controller.
#pragma once
#include <gst/gst.h>

#include "gst/common/properties.h"
#include "src/scream/controller.h"

namespace lidar::gst {

enum EcnMode { kEcnOff, kEcnEct0, kEcnEct1 };
GType EcnModeType();

/// Of one sink pad. A bitrate of 0 takes the element's.
struct TxPadSettings {
  gdouble priority = 1;
  guint min_bps = 0;
  guint start_bps = 0;
  guint max_bps = 0;
};
using TxPadProperties = std::array<Property<TxPadSettings>, 4>;
const TxPadProperties& TxPadPropertyTable();

/// What the core defaults to is said there, once.
struct TxSettings {
  static inline const scream::Parameters kDefault{};
  static guint64 Ns(Duration d) { return static_cast<guint64>(d.count()); }

  guint min_bps = 100'000;
  guint start_bps = 1'000'000;
  guint max_bps = 50'000'000;
  gint ecn_mode = kEcnEct1;
  guint64 max_queue_delay = 200 * GST_MSECOND;
  guint64 stats_interval = 0;
  guint packet_overhead = 28;
  bool send_bye = false;
  bool key_unit_on_loss = false;
  bool pure_draft = false;

  // Constants of the draft
  guint64 qdelay_target_lo = Ns(kDefault.qdelay_target_lo);
  guint64 qdelay_target_hi = Ns(kDefault.qdelay_target_hi);
  guint min_ref_wnd = static_cast<guint>(kDefault.min_ref_wnd.bytes());
  gdouble bytes_in_flight_head_room = kDefault.bytes_in_flight_head_room;
  gdouble beta_loss = kDefault.beta_loss;
  gdouble beta_ecn = kDefault.beta_ecn;
  guint mss = static_cast<guint>(kDefault.mss.bytes());
  gdouble post_congestion_delay_rtt = kDefault.post_congestion_delay_rtt;
  gdouble mul_increase_factor = kDefault.mul_increase_factor;
  guint64 virtual_rtt = Ns(kDefault.virtual_rtt);
  gdouble l4s_avg_g_up = kDefault.l4s_avg_g_up;
  gdouble l4s_avg_g_down = kDefault.l4s_avg_g_down;
  gdouble ref_wnd_overhead_min = kDefault.ref_wnd_overhead_min;
  gdouble ref_wnd_overhead_max = kDefault.ref_wnd_overhead_max;
  guint rate_pace_min = static_cast<guint>(kDefault.rate_pace_min.bits_per_second());
  gdouble packet_pacing_headroom = kDefault.packet_pacing_headroom;
  gdouble max_relaxed_pacing_factor = kDefault.max_relaxed_pacing_factor;
  gdouble relaxed_pacing_limit_low = kDefault.relaxed_pacing_limit_low;
  gdouble rate_adjust_gain = kDefault.rate_adjust_gain;
  gdouble target_rate_divisor = kDefault.target_rate_divisor;
  bool reduce_jitter = kDefault.reduce_jitter;
  bool clock_drift = kDefault.clock_drift;
  bool link_layer_loss = kDefault.link_layer_loss;
  bool rate_policer = kDefault.rate_policer;
  bool undershoot_remedy = kDefault.undershoot_remedy;
  bool competing_flows = kDefault.competing_flows;

  // Beyond the draft
  bool fast_start = kDefault.extensions.fast_start;
  bool drop_response = kDefault.extensions.drop_response;
  bool bounded_flight = kDefault.extensions.bounded_flight;
  bool isolated_loss = kDefault.extensions.isolated_loss;
  bool quick_drain = kDefault.extensions.quick_drain;
  bool answered_signals = kDefault.extensions.answered_signals;
  bool even_alpha = kDefault.extensions.even_alpha;
  bool adaptive_pacing = kDefault.extensions.adaptive_pacing;
  bool feedback_timeout = kDefault.extensions.feedback_timeout;
};
using TxProperties = std::array<Property<TxSettings>, 45>;
const TxProperties& TxPropertyTable();

scream::Parameters ToParameters(const TxSettings& settings);

}  // namespace lidar::gst
