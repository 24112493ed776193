// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/tuning.h"

#include <algorithm>
#include <cmath>

namespace lidar::scream {
namespace {

constexpr double kMinute = 60e9;
constexpr double kGbps = 4e9;

void Assign(double value, bool* field) { *field = value != 0; }
void Assign(double value, double* field) { *field = value; }
void Assign(double value, Duration* field) { *field = Duration{std::llround(value)}; }
void Assign(double value, DataSize* field) { *field = DataSize::Bytes(std::llround(value)); }
void Assign(double value, DataRate* field) { *field = DataRate::BitsPerSecond(value); }

Extensions& OwnerOf(bool Extensions::*, Parameters* p) { return p->extensions; }
template <class T>
Parameters& OwnerOf(T Parameters::*, Parameters* p) {
  return *p;
}

}  // namespace

bool Tunable::Set(double value, Parameters* parameters) const {
  if (!(value >= min && value <= max)) return false;
  std::visit([&](auto m) { Assign(value, &(OwnerOf(m, parameters).*m)); }, member);
  return true;
}

const std::vector<Tunable>& Tunables() {
  using P = Parameters;
  using X = Extensions;
  static const std::vector<Tunable> all = {
      {"qdelay-target-lo", &P::qdelay_target_lo, 1e6, kMinute},
      {"min-ref-wnd", &P::min_ref_wnd, 100, 1e6},
      {"bytes-in-flight-head-room", &P::bytes_in_flight_head_room, 1, 10},
      {"beta-loss", &P::beta_loss, 0.1, 1},
      {"beta-ecn", &P::beta_ecn, 0.1, 1},
      {"mss", &P::mss, 100, 65535},
      {"post-congestion-delay-rtt", &P::post_congestion_delay_rtt, 0, 10000},
      {"mul-increase-factor", &P::mul_increase_factor},
      {"virtual-rtt", &P::virtual_rtt, 1e6, kMinute},
      {"l4s-avg-g", &P::l4s_avg_g},
      {"ref-wnd-overhead-min", &P::ref_wnd_overhead_min, 1, 10},
      {"ref-wnd-overhead-max", &P::ref_wnd_overhead_max, 1, 20},
      {"rate-pace-min", &P::rate_pace_min, 1000, kGbps},
      {"packet-pacing-headroom", &P::packet_pacing_headroom, 1, 10},
      {"max-relaxed-pacing-factor", &P::max_relaxed_pacing_factor, 1, 100},
      {"relaxed-pacing-limit-low", &P::relaxed_pacing_limit_low},
      {"rate-adjust-gain", &P::rate_adjust_gain},
      {"frame-size-dev-alpha", &P::frame_size_dev_alpha},
      {"target-rate-divisor", &P::target_rate_divisor, 1, 4},
      {"loss-rate-threshold", &P::loss_rate_threshold},
      {"reduce-jitter", &P::reduce_jitter},
      {"clock-drift", &P::clock_drift},
      {"link-layer-loss", &P::link_layer_loss},
      {"undershoot-remedy", &P::undershoot_remedy},
      {"capacity", &X::capacity},
      {"evidence", &X::evidence},
      {"gaps", &X::gaps},
      {"company", &X::company},
      {"fast-increase-max", &P::fast_increase_max},
      {"fast-increase-step", &P::fast_increase_step},
      {"fast-increase-step-unmarked", &P::fast_increase_step_unmarked},
      {"fast-increase-slope", &P::fast_increase_slope, 0, 100},
      {"fast-increase-beside", &P::fast_increase_beside},
      {"drop-threshold", &P::drop_threshold, 0.1, 10},
      {"drop-growth", &P::drop_growth, 0, 100},
      {"busy-qdelay-unmarked", &P::busy_qdelay_unmarked},
      {"bounded-overhead", &P::bounded_overhead, 0.5, 10},
      {"open-overhead", &P::open_overhead, 0.5, 10},
      {"isolated-loss-threshold", &P::isolated_loss_threshold},
      {"even-alpha-g", &P::even_alpha_g},
      {"even-alpha-max", &P::even_alpha_max},
      {"min-pacing-reserve", &P::min_pacing_reserve},
      {"max-pacing-reserve", &P::max_pacing_reserve, 0, 0.9},
      {"onset-reserve", &P::onset_reserve},
      {"stall-share", &P::stall_share},
      {"link-may-be-faster", &P::link_may_be_faster, 1, 100},
      {"classic-growth", &P::classic_growth, 0, 10},
      {"early-growth", &P::early_growth, 0, 10},
      {"prague-backoff", &P::prague_backoff, 0, 10},
  };
  return all;
}

const Tunable* FindTunable(std::string_view name) {
  std::string hyphens(name);
  std::replace(hyphens.begin(), hyphens.end(), '_', '-');
  for (const Tunable& t : Tunables())
    if (t.name == hyphens) return &t;
  return nullptr;
}

std::string TunableNames() {
  std::string names;
  for (const Tunable& t : Tunables()) names += (names.empty() ? "" : ", ") + std::string(t.name);
  return names;
}

}  // namespace lidar::scream
