// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/response/competing_flows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lidar::scream {
namespace {

constexpr Duration kSampleInterval = 50ms;
constexpr std::size_t kVarianceSamples = 200;
constexpr std::size_t kAverageSamples = 50;
constexpr double kLossEventGain = 0.02;
constexpr double kLossEventThreshold = 0.002;
constexpr double kSafeVariance = 0.2;

}  // namespace

void CompetingFlows::Update(Time now, Duration qdelay, Duration s_rtt, bool loss) {
  if (!p_.competing_flows) return;
  CountLossEvents(now, s_rtt, loss);
  if (now - last_sample_ < kSampleInterval) return;
  last_sample_ = now;
  qdelay_norm_history_.push_back(Seconds(qdelay) / Seconds(p_.qdelay_target_lo));
  if (qdelay_norm_history_.size() > kVarianceSamples) qdelay_norm_history_.pop_front();
  AdjustQdelayTarget();
}

void CompetingFlows::CountLossEvents(Time now, Duration s_rtt, bool loss) {
  loss_this_rtt_ = loss_this_rtt_ || loss;
  if (now - rtt_start_ < s_rtt) return;
  loss_event_rate_ =
      (1 - kLossEventGain) * loss_event_rate_ + (loss_this_rtt_ ? kLossEventGain : 0);
  loss_this_rtt_ = false;
  rtt_start_ = now;
}

void CompetingFlows::AdjustQdelayTarget() {
  const auto& h = qdelay_norm_history_;
  const auto n = static_cast<double>(h.size());
  const double mean = std::accumulate(h.begin(), h.end(), 0.0) / n;
  double variance = 0;
  for (const double x : h) variance += (x - mean) * (x - mean) / n;
  const std::size_t recent = std::min(h.size(), kAverageSamples);
  const double average =
      std::accumulate(h.end() - static_cast<std::ptrdiff_t>(recent), h.end(), 0.0) /
      static_cast<double>(recent);
  const Duration new_target =
      FromSeconds((average + std::sqrt(variance)) * Seconds(p_.qdelay_target_lo));
  if (loss_event_rate_ > kLossEventThreshold)
    qdelay_target_ = new_target * 3 / 2;
  else if (variance < kSafeVariance)
    qdelay_target_ = new_target;
  else if (new_target < p_.qdelay_target_lo)
    qdelay_target_ = std::max(qdelay_target_ / 2, new_target);
  else
    qdelay_target_ = qdelay_target_ * 9 / 10;
  qdelay_target_ = std::clamp(qdelay_target_, p_.qdelay_target_lo, p_.qdelay_target_hi);
}

}  // namespace lidar::scream
