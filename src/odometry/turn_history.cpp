// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/turn_history.h"

#include <algorithm>
#include <cmath>

namespace lidar::odometry {
namespace {

/// A longer pause between samples hides how the sensor turned. IMUs give at least 100 samples a
/// second, and samples of the last slice may still be under way.
constexpr Duration kLongestStep = std::chrono::milliseconds(50);
constexpr Duration kNewClock = std::chrono::seconds(1);
constexpr double kMostRate = 50;  // [rad/s]: vehicles turn slower
constexpr double kMostBias = 0.2;
/// Least part of a scan's error that enters the bias. The first scans have more weight: an offset
/// is about as large as the noise of kOffsetScans.
constexpr double kBiasShare = 0.05;
constexpr int kOffsetScans = 3;
constexpr double kMemory = 0.9;
/// Error of an alignment itself [rad].
constexpr double kNoise = 0.003;
constexpr int kLeastTaught = 5;  // scans

Eigen::Vector3d LogOf(const Eigen::Quaterniond& turn) {
  return Log({turn, Eigen::Vector3d::Zero()}).tail<3>();
}
Eigen::Quaterniond ExpOf(const Eigen::Vector3d& turn) {
  Twist twist = Twist::Zero();
  twist.tail<3>() = turn;
  return Exp(twist).rotation;
}

}  // namespace

void TurnHistory::Add(Time time, const Eigen::Vector3d& rate) {
  if (!rate.allFinite() || rate.norm() > kMostRate) return;
  if (!samples_.empty() && time <= samples_.back().time) {
    if (samples_.back().time - time < kNewClock) return;
    samples_.clear();
  }
  samples_.push_back({time, rate});
  while (samples_.size() > kMostSamples || time - samples_.front().time > kKept)
    samples_.pop_front();
}

Eigen::Vector3d TurnHistory::RateAt(Time t) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), t,
                                      [](const Sample& s, Time at) { return s.time < at; });
  if (after == samples_.end()) return samples_.back().rate;
  if (after == samples_.begin()) return after->rate;
  const Sample& before = *(after - 1);
  const double part = Seconds(t - before.time) / Seconds(after->time - before.time);
  return before.rate + part * (after->rate - before.rate);
}

std::optional<Eigen::Quaterniond> TurnHistory::Between(Time from, Time to) const {
  if (samples_.empty() || from < samples_.front().time - kLongestStep ||
      to > samples_.back().time + kLongestStep)
    return std::nullopt;
  auto next = std::upper_bound(samples_.begin(), samples_.end(), from,
                               [](Time at, const Sample& s) { return at < s.time; });
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Eigen::Vector3d rate = RateAt(from);
  for (Time at = from; at < to;) {
    const Time end = next == samples_.end() ? to : std::min(to, next->time);
    if (end - at > kLongestStep) return std::nullopt;
    const Eigen::Vector3d last = RateAt(end);
    turn = turn * ExpOf(((rate + last) / 2 - bias_) * Seconds(end - at));
    rate = last;
    at = end;
    if (next != samples_.end()) ++next;
  }
  return turn.normalized();
}

void TurnHistory::Teach(Time from, Time to, const Eigen::Quaterniond& found,
                        const Eigen::Quaterniond& steady) {
  const auto own = Between(from, to);
  if (!own || to <= from) return;
  const Eigen::Vector3d off = LogOf(found.conjugate() * *own);
  own_squares_ = kMemory * own_squares_ + off.squaredNorm();
  steady_squares_ = kMemory * steady_squares_ + LogOf(found.conjugate() * steady).squaredNorm();
  ++taught_;
  bias_ += std::max(kBiasShare, 1.0 / (kOffsetScans + taught_)) * off / Seconds(to - from);
  if (bias_.norm() > kMostBias) bias_ *= kMostBias / bias_.norm();
}

bool TurnHistory::trusted() const {
  return taught_ >= kLeastTaught &&
         own_squares_ <= steady_squares_ + kNoise * kNoise / (1 - kMemory);
}

}  // namespace lidar::odometry
