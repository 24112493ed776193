// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/model/queue_delay.h"

#include <algorithm>

namespace lidar::scream {
namespace {

/// The base history covers ten minutes, as in RFC 6817.
constexpr Duration kBaseInterval = 10s;
constexpr std::size_t kBaseHistory = 60;
/// A shorter base history is used if marks prevent a long-standing queue.
constexpr std::size_t kBaseHistoryMarked = 3;
/// A clock has jumped if a delay is shorter than its minimum by more than this.
constexpr Duration kJump = 100ms;

Duration Scale(Duration d, double f) { return FromSeconds(Seconds(d) * f); }

}  // namespace

void QueueDelay::Reset() {
  ForgetBase();
  qdelay_max_avg_ = p_.qdelay_target_lo;
  qdelay_min_avg_ = qdelay_dev_avg_ = Duration{0};
  ref_wnd_delay_scale_ = 1;
  last_update_qdelay_avg_time_ = rtt_start_ = Time{};
}

void QueueDelay::ForgetBase() {
  history_.clear();
  base_.reset();
  shortest_back_.Forget();
  qdelay_ = qdelay_avg_ = Duration{0};
  slow_min_avg_ = Duration{0};
  min_this_rtt_ = Duration::max();
}

/// Returns true if a clock has jumped. A queue can only lengthen delays, but a clock that is set
/// makes the delay in one direction shorter than its minimum.
bool QueueDelay::Jumped(Time now, Duration owd, Duration way_back) {
  if (!p_.extensions.evidence) return false;
  const bool way_back_jumped = shortest_back_.Add(now, way_back) > kJump;
  return owd < *base_ - kJump || way_back_jumped;
}

void QueueDelay::AddToBase(Time now, Duration owd, bool short_history) {
  if (history_.empty() || now - history_.back().since >= kBaseInterval) {
    history_.push_back({now, owd});
    while (history_.size() > (short_history ? kBaseHistoryMarked : kBaseHistory))
      history_.pop_front();
    base_ = owd;
    for (const Base& b : history_) base_ = std::min(*base_, b.min);
  }
  history_.back().min = std::min(history_.back().min, owd);
  base_ = std::min(*base_, owd);
}

bool QueueDelay::Add(Time now, const DelaySample& sample, bool short_history) {
  const Duration owd = sample.arrival - sample.sent;
  const bool jumped = base_ && Jumped(now, owd, sample.way_back);
  if (jumped) {
    ForgetBase();
    // The new base does not include the delay of the current queue, which the round trip still
    // shows.
    AddToBase(now, owd - sample.rtt_excess, short_history);
  }
  AddToBase(now, owd, short_history);
  qdelay_ = owd - *base_;
  min_this_rtt_ = std::min(min_this_rtt_, qdelay_);
  return !jumped;
}

bool QueueDelay::Update(Time now, Duration s_rtt) {
  if (p_.reduce_jitter) {
    qdelay_max_avg_ = std::min(p_.qdelay_target_lo, std::max(qdelay_, qdelay_max_avg_));
    qdelay_min_avg_ = std::min(qdelay_, qdelay_min_avg_);
  }
  const bool new_base = p_.clock_drift && UpdateDrift(now, s_rtt);
  if (now - last_update_qdelay_avg_time_ < std::min(p_.virtual_rtt, s_rtt)) return new_base;
  last_update_qdelay_avg_time_ = now;
  qdelay_avg_falls_ = qdelay_ < qdelay_avg_;
  qdelay_avg_ = qdelay_avg_falls_
                    ? qdelay_
                    : Scale(qdelay_, p_.qdelay_avg_g) + Scale(qdelay_avg_, 1 - p_.qdelay_avg_g);
  if (p_.reduce_jitter) CalculateRefWndDelayScale();
  return new_base;
}

void QueueDelay::CalculateRefWndDelayScale() {
  const double g = p_.qdelay_min_max_avg_g;
  qdelay_max_avg_ = Scale(qdelay_max_avg_, 1 - g);
  qdelay_min_avg_ = Scale(qdelay_min_avg_, 1 - g) + Scale(qdelay_max_avg_, g);
  qdelay_dev_avg_ = Scale(qdelay_dev_avg_, 1 - p_.qdelay_dev_avg_g) +
                    Scale(qdelay_max_avg_ - qdelay_min_avg_, p_.qdelay_dev_avg_g);
  const double relative = Seconds(qdelay_dev_avg_) / Seconds(p_.qdelay_dev_threshold);
  ref_wnd_delay_scale_ = std::clamp(1 - relative, 0.0, 1.0);
}

bool QueueDelay::UpdateDrift(Time now, Duration s_rtt) {
  if (now - rtt_start_ < s_rtt || min_this_rtt_ == Duration::max()) return false;
  const double g = p_.qdelay_min_avg_alpha;
  slow_min_avg_ = Scale(slow_min_avg_, 1 - g) + Scale(min_this_rtt_, g);
  min_this_rtt_ = Duration::max();
  rtt_start_ = now;
  if (slow_min_avg_ <= p_.qdelay_target_lo / 4) return false;
  ForgetBase();
  return true;
}

}  // namespace lidar::scream
