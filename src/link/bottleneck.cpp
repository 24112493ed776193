// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/bottleneck.h"

#include <algorithm>
#include <tuple>

namespace lidar::link {
namespace {

std::unique_ptr<Aqm> MakeAqm(const AqmConfig& config, Random random) {
  switch (config.kind) {
    case AqmConfig::Kind::kStep:
      return StepAqm(config.high);
    case AqmConfig::Kind::kRamp:
      return RampAqm(config.low, config.high, random);
    case AqmConfig::Kind::kPi2:
      return Pi2Aqm(config.pi2, random);
    case AqmConfig::Kind::kNone:
    case AqmConfig::Kind::kDualPi2:
      break;
  }
  return NoAqm();
}

std::unique_ptr<Queue> MakeQueue(const AqmConfig& config, Random random) {
  if (config.kind == AqmConfig::Kind::kDualPi2) return DualPi2Queue(config.pi2, random);
  return std::make_unique<FifoQueue>(MakeAqm(config, random));
}

/// Returns t + d, or Time::max() if the sum is larger. Time::max() means never.
Time Plus(Time t, Duration d) { return d < Time::max() - t ? t + d : Time::max(); }

}  // namespace

bool Bottleneck::Later::operator()(const Pending& a, const Pending& b) const {
  return std::tie(a.outcome.arrival, a.order) > std::tie(b.outcome.arrival, b.order);
}

Bottleneck::Bottleneck(const BottleneckConfig& config)
    : config_(config),
      loss_random_(config.seed),
      // Losses and marks have separate random sequences, so that losses do not change the marks.
      queue_(MakeQueue(config.aqm, Random(config.seed + 1))),
      path_(config.path, config.seed + 2),
      limit_(config.limit.bytes),
      free_at_(config.origin) {}

bool Bottleneck::Full(Time now, DataSize size) {
  const DataRate rate = config_.capacity.RateAt(now - config_.origin);
  // The last limit remains during a gap of the capacity, because a real buffer does not shrink to
  // nothing.
  if (config_.limit.time < Duration::max() && rate > DataRate{} && rate < DataRate::Infinite())
    limit_ = std::min(config_.limit.bytes, rate * config_.limit.time);
  // An empty queue accepts any packet.
  return !queue_->empty() && size > limit_ - queue_->size();
}

void Bottleneck::Enqueue(Time now, const Packet& packet) {
  Advance(now);
  ++stats_.sent;
  Outcome dropped{packet, Fate::kLost, now, now};
  if (loss_random_.Chance(config_.loss)) {
    Conclude(dropped);
  } else if (Full(now, packet.size)) {
    dropped.fate = Fate::kQueueFull;
    Conclude(dropped);
  } else {
    queue_->Push({packet, now});
    Advance(now);
  }
}

Time Bottleneck::NextEventTime() const {
  const Time arrival = pending_.empty() ? Time::max() : pending_.top().outcome.arrival;
  return queue_->empty() ? arrival : std::min(arrival, free_at_);
}

std::vector<Outcome> Bottleneck::Deliver(Time now) {
  Advance(now);
  std::vector<Outcome> outcomes;
  while (!pending_.empty() && pending_.top().outcome.arrival <= now) {
    const Outcome& outcome = pending_.top().outcome;
    stats_.duplicated += outcome.duplicate;
    if (outcome.delivered() && !outcome.duplicate) {
      ++stats_.delivered;
      stats_.delivered_size += outcome.packet.size;
    }
    outcomes.push_back(outcome);
    pending_.pop();
  }
  return outcomes;
}

Time Bottleneck::At(Duration capacity_time) const {
  return capacity_time == Duration::max() ? Time::max() : Plus(config_.origin, capacity_time);
}

void Bottleneck::Advance(Time now) {
  while (!queue_->empty()) {
    const Time start = std::max(free_at_, queue_->Oldest());
    if (start > now) return;
    if (config_.capacity.RateAt(start - config_.origin) <= DataRate{}) {
      // Packets stay in the queue during a gap, so their sojourn continues.
      free_at_ = At(config_.capacity.NextChange(start - config_.origin));
      continue;
    }
    Transmit(queue_->Pop(start), start);
  }
}

void Bottleneck::Transmit(const Leaving& leaving, Time now) {
  const Waiting& head = leaving.waiting;
  Outcome outcome{head.packet, Fate::kDelivered, head.entered, now, now - head.entered};
  if (leaving.verdict == Verdict::kDrop) {
    outcome.fate = Fate::kAqmDropped;
    Conclude(outcome);
    return;
  }
  if (leaving.verdict == Verdict::kMark && head.packet.ecn != Ecn::kCe) {
    outcome.packet.ecn = Ecn::kCe;
    ++stats_.marked;
  }
  free_at_ = At(config_.capacity.Finish(now - config_.origin, head.packet.size));
  const Time ideal = Plus(free_at_, config_.delay);
  outcome.arrival = ideal < Time::max() ? path_.Arrival(ideal) : ideal;
  Conclude(outcome);
  if (!path_.Duplicates()) return;
  outcome.duplicate = true;
  Conclude(outcome);
}

void Bottleneck::Conclude(const Outcome& outcome) {
  stats_.lost += outcome.fate == Fate::kLost;
  stats_.queue_full += outcome.fate == Fate::kQueueFull;
  stats_.aqm_dropped += outcome.fate == Fate::kAqmDropped;
  pending_.push({outcome, order_++});
}

}  // namespace lidar::link
