// SPDX-License-Identifier: LGPL-2.1-or-later
// Beyond the draft: finds other flows at the bottleneck, and its capacity for all flows.
#pragma once
#include <algorithm>
#include <optional>
#include <utility>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {

/// While the bottleneck's queue is not empty, only packets of other flows come between our
/// arrivals. In a linear fit of arrival gaps over departure gaps, the slope is the others' share of
/// the link, and the intercept is the link's time for one of our packets. The pacer makes
/// departures slightly uneven for this measurement, which takes many packets because arrival times
/// of reports are coarse.
class CrossTraffic {
 public:
  struct Packet {
    Time sent{};
    Time arrival{};
    DataSize size;
  };

  /// `congested`: marks or losses prove the queue. Jitter or clock drift may look like a queue, and
  /// an idle link then looks like other flows: arrival gaps follow departure gaps on both.
  void Add(const Packet& packet, Duration qdelay, bool congested) {
    if (!congested) {
      Skip(packet.sent);
      return;
    }
    // The queue that earlier packets met decides, because whether a packet counts must not depend
    // on its own arrival.
    const double waited_ms = std::min(lately_waited_ms_, waited_ms_);
    waited_ms_ = Ms(qdelay);
    lately_waited_ms_ += (waited_ms_ - lately_waited_ms_) / 4;
    const auto previous = std::exchange(last_, packet);
    if (!previous || packet.sent <= previous->sent || packet.arrival < previous->arrival) return;
    const double sent_ms = Ms(packet.sent - previous->sent);
    const double arrived_ms = Ms(packet.arrival - previous->arrival);
    spacing_ms_ += (sent_ms - spacing_ms_) / 16;
    const bool idle = waited_ms < std::max(sent_ms, kLongestGap * spacing_ms_) + kTickMs;
    const bool alone = share().value_or(1) < kShareToFind;
    unseen_ = alone ? 0 : std::min(unseen_ + Weight(sent_ms), kDecisionWeight);
    Scale(1 - (idle ? Weight(sent_ms) : 1) / kPackets);
    if (idle || arrived_ms > kPauseMs) return;
    const int weight = Weight(Ms(packet.sent - std::exchange(counted_, packet.sent)));
    Count(sent_ms, arrived_ms, static_cast<double>(packet.size.bytes()));
    Decide(weight);
  }
  /// Call it at each report: only arrival times within a report have the same rounding.
  void BeginReport() { last_.reset(); }
  /// Returns true if other flows were found. The result stays while departures are too even to show
  /// them.
  bool found() const { return found_; }
  /// Share of the link that others use while we send; unset while too little is known.
  std::optional<double> share() const {
    if (sent_sent_ < kEvidence) return std::nullopt;
    return sent_arrived_ / sent_sent_;
  }
  /// Returns true after a long queue of unknown origin. Other flows may fill it, but our packets
  /// are too far apart, or reports too coarse, to show them.
  bool unseen() const { return unseen_ >= kDecisionWeight; }
  /// Capacity of the link for all flows; unset while share() is unset.
  std::optional<DataRate> link_rate() const {
    const auto share = this->share();
    const double own_ms = arrived_.value - share.value_or(0) * sent_.value;
    if (!share || own_ms <= 0) return std::nullopt;
    return DataRate::BitsPerSecond(bytes_.value * 8e3 / own_ms);
  }

 private:
  /// An exponential moving average, in which a new value has the weight `weight`.
  struct Average {
    double value = 0;
    void Add(double x, double weight) { value += (x - value) * weight; }
  };

  static double Ms(Duration d) { return 1e3 * Seconds(d); }
  void Skip(Time sent) {
    last_.reset();
    if (sent - counted_ > kForgotten) *this = CrossTraffic();
  }
  void Count(double sent_ms, double arrived_ms, double bytes) {
    const double weight = std::max(1 / kPackets, 1 / ++counted_packets_);
    sent_.Add(sent_ms, weight);
    arrived_.Add(arrived_ms, weight);
    bytes_.Add(bytes, weight);
    // Spacings count relative to recent averages, because our rate and the link's change them.
    lately_sent_.Add(sent_ms, 1 / kLately);
    lately_arrived_.Add(arrived_ms, 1 / kLately);
    const double sent = sent_ms - lately_sent_.value;
    sent_sent_ += sent * sent;
    sent_arrived_ += sent * (arrived_ms - lately_arrived_.value);
    if (sent_sent_ > kMostEvidence) Scale(kMostEvidence / sent_sent_);
  }
  /// Ages the evidence: a share without new evidence becomes unknown, and old evidence does not
  /// outweigh new.
  void Scale(double factor) {
    sent_sent_ *= factor;
    sent_arrived_ *= factor;
  }
  /// Returns the time between packets [ms] as a weight, so that a few packets far apart weigh as
  /// much as many close ones.
  static int Weight(double apart_ms) {
    return static_cast<int>(std::clamp(apart_ms, 1.0, kMostWeight));
  }
  /// Changes the decision only after much evidence against it: a start, or a step of the capacity,
  /// must be over first.
  void Decide(int weight) {
    const auto share = this->share();
    const bool same = !share || (*share > kShareToFind) == found_;
    against_ = same ? 0 : against_ + weight;
    if (against_ < kDecisionWeight) return;
    found_ = !found_;
    against_ = 0;
  }

  static constexpr double kLately = 8;
  static constexpr double kPackets = 2048;
  static constexpr int kDecisionWeight = 768;  // number of packets, or milliseconds between them
  static constexpr double kMostWeight = 10;
  static constexpr Duration kForgotten = std::chrono::seconds(10);
  /// A longer pause is a gap of the link, or a clock that was set.
  static constexpr double kPauseMs = 15;
  /// Longest gap between the pacer's departures, in average gaps.
  static constexpr double kLongestGap = 1.5;
  /// Mean error of delays, because arrival times are rounded up.
  static constexpr double kTickMs = 0.5;
  /// Sum of squared deviations of departure gaps [ms^2] that shows the share: rounding of arrival
  /// times to 1/1024 s then leaves an error of 0.1.
  static constexpr double kEvidence = 30;
  static constexpr double kMostEvidence = 2 * kEvidence;
  static constexpr double kShareToFind = 0.2;
  std::optional<Packet> last_;
  Time counted_{};
  double waited_ms_ = 0;         // wait of the last packet
  double lately_waited_ms_ = 0;  // mean wait of some packets before it
  double spacing_ms_ = 0;
  double counted_packets_ = 0;
  Average sent_, arrived_, bytes_;
  Average lately_sent_, lately_arrived_;
  double sent_sent_ = 0, sent_arrived_ = 0;  // sums of products
  int unseen_ = 0;   // weight since the queue was last known to be ours alone
  int against_ = 0;  // weight since a share last agreed with `found_`
  bool found_ = false;
};

}  // namespace lidar::scream
