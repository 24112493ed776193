// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/turn_history.h"

#include <algorithm>
#include <cmath>

namespace lidar::odometry {
namespace {

/// The longest time between two samples. A longer gap hides how the sensor turned; IMUs give at
/// least 100 samples/s. The last sample is valid for the same time, because the next samples may
/// not have arrived yet.
constexpr Duration kLongestStep = std::chrono::milliseconds(50);
constexpr Duration kNewClock = std::chrono::seconds(1);
constexpr double kMostRate = 50;  // no vehicle turns faster [rad/s]
constexpr double kMostBias = 0.2;
/// The least weight of a scan in the estimate of the bias; the first scans have more weight. The
/// initial bias of zero has as much weight as kOffsetScans scans.
constexpr double kBiasShare = 0.05;
constexpr int kOffsetScans = 3;
constexpr double kMemory = 0.9;
/// The error of a rotation that is found by alignment [rad].
constexpr double kNoise = 0.003;
constexpr int kLeastTaught = 5;  // number of scans
/// The least weight of a scan in the estimate of the force at rest. The first scans have more
/// weight, so that their mean is the first estimate.
constexpr double kRestShare = 0.02;
constexpr int kLeastForcesTaught = 10;  // number of scans
/// The forces that the IMU measures are trusted if they predict the path well. Their squared error
/// may be at most this many times the squared error of a prediction by the mean velocity. The limit
/// is above 1, because poses that were found without forces have errors themselves. If the axes of
/// the IMU are reversed, the ratio is four.
constexpr double kMostForceError = 2;
/// Half of gravity [m/s^2]. At rest, an IMU without an accelerometer or with other units shows less
/// than this.
constexpr double kLeastRest = 5;
constexpr double kMostForce = 1000;  // force in a crash [m/s^2]

Eigen::Vector3d LogOf(const Eigen::Quaterniond& turn) {
  return Log({turn, Eigen::Vector3d::Zero()}).tail<3>();
}
Eigen::Quaterniond ExpOf(const Eigen::Vector3d& turn) {
  Twist twist = Twist::Zero();
  twist.tail<3>() = turn;
  return Exp(twist).rotation;
}

}  // namespace

void TurnHistory::Add(Time time, const Eigen::Vector3d& rate, const Eigen::Vector3d& force) {
  if (!rate.allFinite() || rate.norm() > kMostRate) return;
  if (!force.allFinite() || force.norm() > kMostForce) return;
  if (!samples_.empty() && time <= samples_.back().time) {
    if (samples_.back().time - time < kNewClock) return;
    samples_.clear();
  }
  samples_.push_back({time, rate, force});
  while (samples_.size() > kMostSamples || time - samples_.front().time > kKept)
    samples_.pop_front();
}

TurnHistory::Sample TurnHistory::SampleAt(Time t) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), t,
                                      [](const Sample& s, Time at) { return s.time < at; });
  if (after == samples_.end()) return samples_.back();
  if (after == samples_.begin()) return *after;
  const Sample& before = *(after - 1);
  const double part = Seconds(t - before.time) / Seconds(after->time - before.time);
  return {t, before.rate + part * (after->rate - before.rate),
          before.force + part * (after->force - before.force)};
}

std::optional<Eigen::Quaterniond> TurnHistory::Between(Time from, Time to) const {
  const auto span = SpanBetween(from, to);
  return span ? std::optional(span->turn) : std::nullopt;
}

std::optional<TurnHistory::Span> TurnHistory::SpanBetween(Time from, Time to) const {
  if (samples_.empty() || from < samples_.front().time - kLongestStep ||
      to > samples_.back().time + kLongestStep)
    return std::nullopt;
  auto next = std::upper_bound(samples_.begin(), samples_.end(), from,
                               [](Time at, const Sample& s) { return at < s.time; });
  Span span;
  Sample sample = SampleAt(from);
  for (Time at = from; at < to;) {
    const Time end = next == samples_.end() ? to : std::min(to, next->time);
    if (end - at > kLongestStep) return std::nullopt;
    const Sample last = SampleAt(end);
    const double step = Seconds(end - at);
    const Eigen::Quaterniond before = span.turn;
    span.turn = span.turn * ExpOf(((sample.rate + last.rate) / 2 - bias_) * step);
    const Eigen::Vector3d pushed = (before * sample.force + span.turn * last.force) / 2 * step;
    span.way += (span.velocity + pushed / 2) * step;
    span.velocity += pushed;
    sample = last;
    at = end;
    if (next != samples_.end()) ++next;
  }
  span.turn.normalize();
  return span;
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

/// Returns the state after the motion `span`. The force at rest is subtracted, because it only
/// balances gravity.
Moving TurnHistory::After(const Moving& at, const Span& span, double seconds) const {
  const Eigen::Vector3d rest = at.pose.rotation.conjugate() * rest_;
  const Eigen::Vector3d start = at.velocity.head<3>();
  Moving after = at;
  after.pose =
      at.pose * Pose{span.turn, start * seconds + span.way - rest * (seconds * seconds / 2)};
  after.velocity.head<3>() = span.turn.conjugate() * (start + span.velocity - rest * seconds);
  return after;
}

std::optional<Moving> TurnHistory::Move(const Moving& at, Time from, Time to) const {
  if (!force_trusted()) return std::nullopt;
  auto span = SpanBetween(std::min(from, to), std::max(from, to));
  if (!span) return std::nullopt;
  if (to >= from) return After(at, *span, Seconds(to - from));
  // Reverses the span: the motion from its end to its start.
  const double seconds = Seconds(from - to);
  const Eigen::Quaterniond back = span->turn.conjugate();
  span->way = back * (span->velocity * seconds - span->way);
  span->velocity = back * -span->velocity;
  span->turn = back;
  return After(at, *span, -seconds);
}

void TurnHistory::TeachForce(Time from, Time to, const Moving& before, const Moving& found) {
  const auto span = SpanBetween(from, to);
  if (!span || to <= from) {
    reached_.reset();
    return;
  }
  const double seconds = Seconds(to - from);
  const auto velocity = [](const Moving& state) {
    return Eigen::Vector3d(state.pose.rotation * state.velocity.head<3>());
  };
  const Eigen::Matrix3d frame = before.pose.rotation.toRotationMatrix();
  const Eigen::Vector3d way = found.pose.position - before.pose.position;
  const Eigen::Vector3d pushed_way = frame * span->way - rest_ * (seconds * seconds / 2);
  const Eigen::Vector3d pushed = frame * span->velocity - rest_ * seconds;
  if (reached_ && forces_taught_ >= kLeastTaught) {
    force_squares_ =
        kMemory * force_squares_ + (reached_->velocity * seconds + pushed_way - way).squaredNorm();
    mean_squares_ = kMemory * mean_squares_ + (reached_->mean * seconds - way).squaredNorm();
  }
  reached_ = Reached{way / seconds, (way - pushed_way) / seconds + pushed};
  const Eigen::Vector3d rest =
      (frame * span->velocity - (velocity(found) - velocity(before))) / seconds;
  rest_ += std::max(kRestShare, 1.0 / ++forces_taught_) * (rest - rest_);
}

bool TurnHistory::force_trusted() const {
  return trusted() && forces_taught_ >= kLeastForcesTaught && rest_.norm() >= kLeastRest &&
         force_squares_ <= kMostForceError * mean_squares_;
}

bool TurnHistory::trusted() const {
  return taught_ >= kLeastTaught &&
         own_squares_ <= steady_squares_ + kNoise * kNoise / (1 - kMemory);
}

}  // namespace lidar::odometry
