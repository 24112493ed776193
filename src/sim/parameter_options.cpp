// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/parameter_options.h"

#include <cstdlib>
#include <map>
#include <string>

namespace lidar::scream::test {
namespace {

/// Constants that --set turns, by the draft's (or the extension's) name.
const std::map<std::string, double Parameters::*> kConstants = {
    {"min_pacing_reserve", &Parameters::min_pacing_reserve},
    {"max_pacing_reserve", &Parameters::max_pacing_reserve},
    {"onset_reserve", &Parameters::onset_reserve},
    {"stall_share", &Parameters::stall_share},
    {"needed_margin", &Parameters::needed_margin},
    {"link_may_be_faster", &Parameters::link_may_be_faster},
    {"fast_increase_beside", &Parameters::fast_increase_beside},
    {"open_overhead", &Parameters::open_overhead},
    {"packet_pacing_headroom", &Parameters::packet_pacing_headroom},
    {"target_rate_divisor", &Parameters::target_rate_divisor},
    {"mul_increase_factor", &Parameters::mul_increase_factor},
    {"post_congestion_delay_rtt", &Parameters::post_congestion_delay_rtt},
    {"l4s_avg_g_up", &Parameters::l4s_avg_g_up},
    {"l4s_avg_g_down", &Parameters::l4s_avg_g_down},
    {"beta_loss", &Parameters::beta_loss},
    {"bytes_in_flight_head_room", &Parameters::bytes_in_flight_head_room},
    {"ref_wnd_overhead_min", &Parameters::ref_wnd_overhead_min},
    {"ref_wnd_overhead_max", &Parameters::ref_wnd_overhead_max},
    {"rate_adjust_gain", &Parameters::rate_adjust_gain},
    {"frame_size_dev_alpha", &Parameters::frame_size_dev_alpha},
    {"loss_rate_threshold", &Parameters::loss_rate_threshold},
    {"fast_increase_max", &Parameters::fast_increase_max},
    {"fast_increase_step", &Parameters::fast_increase_step},
    {"fast_increase_step_unmarked", &Parameters::fast_increase_step_unmarked},
    {"busy_qdelay_unmarked", &Parameters::busy_qdelay_unmarked},
    {"even_alpha_g", &Parameters::even_alpha_g},
    {"even_alpha_max", &Parameters::even_alpha_max},
    {"fast_increase_slope", &Parameters::fast_increase_slope},
    {"drop_threshold", &Parameters::drop_threshold},
    {"drop_growth", &Parameters::drop_growth},
    {"drop_beta", &Parameters::drop_beta},
    {"bounded_overhead", &Parameters::bounded_overhead},
    {"isolated_loss_threshold", &Parameters::isolated_loss_threshold},
    {"classic_growth", &Parameters::classic_growth},
    {"early_growth", &Parameters::early_growth},
    {"prague_backoff", &Parameters::prague_backoff},
};

const std::map<std::string, bool Extensions::*> kExtensions = {
    {"fast_start", &Extensions::fast_start},
    {"drop_response", &Extensions::drop_response},
    {"bounded_flight", &Extensions::bounded_flight},
    {"isolated_loss", &Extensions::isolated_loss},
    {"adaptive_pacing", &Extensions::adaptive_pacing},
    {"answered_signals", &Extensions::answered_signals},
    {"even_alpha", &Extensions::even_alpha},
    {"quick_drain", &Extensions::quick_drain},
    {"feedback_timeout", &Extensions::feedback_timeout},
    {"gap_recovery", &Extensions::gap_recovery},
    {"needed_floor", &Extensions::needed_floor},
    {"classic_ecn", &Extensions::classic_ecn},
    {"clock_care", &Extensions::clock_care},
    {"shared_link", &Extensions::shared_link},
};
const std::map<std::string, bool Parameters::*> kOptionalParts = {
    {"reduce_jitter", &Parameters::reduce_jitter},
    {"clock_drift", &Parameters::clock_drift},
    {"link_layer_loss", &Parameters::link_layer_loss},
    {"undershoot_remedy", &Parameters::undershoot_remedy},
};

/// NAME=VALUE
bool Set(const std::string& text, Parameters* parameters) {
  const std::size_t equals = text.find('=');
  const auto it = kConstants.find(text.substr(0, equals));
  if (equals == std::string::npos || it == kConstants.end()) return false;
  parameters->*it->second = std::atof(text.c_str() + equals + 1);
  return true;
}

}  // namespace

std::vector<std::string> SwitchNames() {
  const Parameters usual;
  std::vector<std::string> names;
  for (const auto& [name, member] : kExtensions) names.push_back(name);
  for (const auto& [name, member] : kOptionalParts)
    if (usual.*member) names.push_back(name);
  return names;
}

bool Switch(const std::string& name, bool on, Parameters* parameters) {
  if (const auto it = kExtensions.find(name); it != kExtensions.end())
    parameters->extensions.*it->second = on;
  else if (const auto part = kOptionalParts.find(name); part != kOptionalParts.end())
    parameters->*part->second = on;
  else
    return false;
  return true;
}

int TakeParameterOption(int argc, char** argv, int i, Parameters* parameters) {
  const std::string arg = argv[i];
  if (arg == "--draft") {
    *parameters = Parameters::Draft();
    return 1;
  }
  if (arg != "--with" && arg != "--without" && arg != "--set") return 0;
  if (i + 1 >= argc) return -1;
  const std::string value = argv[i + 1];
  const bool known =
      arg == "--set" ? Set(value, parameters) : Switch(value, arg == "--with", parameters);
  return known ? 2 : -1;
}

}  // namespace lidar::scream::test
