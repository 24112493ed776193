// SPDX-License-Identifier: LGPL-2.1-or-later
// Beyond the draft: detects other flows at the bottleneck, and measures the bottleneck's capacity
// for all flows.
#pragma once
#include <algorithm>
#include <optional>
#include <utility>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {

/// While the bottleneck's queue is not empty, only packets of other flows arrive between two of our
/// packets. A line is fitted to the arrival gaps as a function of the departure gaps. Its slope is
/// the share of the link that the other flows use. Its intercept is the time that the link takes
/// for one of our packets. The pacer makes departures slightly uneven, because even departures do
/// not show the slope. The measurement takes many packets, because the arrival times in reports are
/// coarse.
class CrossTraffic {
 public:
  struct Packet {
    Time sent{};
    Time arrival{};
    DataSize size;
  };

  /// `congested` is true if marks or losses prove that there is a queue. Without this proof, jitter
  /// or clock drift may look like a queue. An idle link would then look like a link with other
  /// flows, because arrival gaps follow departure gaps in both cases.
  void Add(const Packet& packet, Duration qdelay, bool congested) {
    if (!congested) {
      Skip(packet.sent);
      return;
    }
    // A packet counts if earlier packets met a queue. Its own arrival must not decide, because a
    // selection by arrival times would distort the fit.
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
  /// Call it at the start of each report, because only arrival times in the same report have the
  /// same rounding.
  void BeginReport() { last_.reset(); }
  /// Returns true if other flows were detected. The result does not change while departures are too
  /// even to show other flows.
  bool found() const { return found_; }
  /// Returns the share of the link that other flows use while we send, or nothing while too little
  /// is known.
  std::optional<double> share() const {
    if (sent_sent_ < kEvidence) return std::nullopt;
    return sent_arrived_ / sent_sent_;
  }
  /// Returns true after a long queue of unknown origin. Other flows may have filled it, although
  /// they could not be measured, because our packets are too far apart or reports are too coarse.
  bool unseen() const { return unseen_ >= kDecisionWeight; }
  /// Returns the capacity of the link for all flows, or nothing while too little is known.
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
    // Gaps are compared with recent averages, because the averages follow changes of our rate and
    // of the link's rate.
    lately_sent_.Add(sent_ms, 1 / kLately);
    lately_arrived_.Add(arrived_ms, 1 / kLately);
    const double sent = sent_ms - lately_sent_.value;
    sent_sent_ += sent * sent;
    sent_arrived_ += sent * (arrived_ms - lately_arrived_.value);
    if (sent_sent_ > kMostEvidence) Scale(kMostEvidence / sent_sent_);
  }
  /// Reduces the weight of old evidence. Without new evidence the share becomes unknown, and old
  /// evidence does not outweigh new evidence.
  void Scale(double factor) {
    sent_sent_ *= factor;
    sent_arrived_ *= factor;
  }
  /// Returns the time between packets [ms] as a weight. A few packets that are far apart then weigh
  /// as much as many packets that are close together.
  static int Weight(double apart_ms) {
    return static_cast<int>(std::clamp(apart_ms, 1.0, kMostWeight));
  }
  /// Changes `found_` only after much evidence against it. The start of a flow, or a step of the
  /// capacity, is over by then.
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
  /// A longer arrival gap [ms] is a gap of the link, or a clock that was set.
  static constexpr double kPauseMs = 15;
  /// The longest gap between departures that the pacer makes, relative to the average gap.
  static constexpr double kLongestGap = 1.5;
  /// The mean error of measured delays [ms], which is due to arrival times that are rounded up.
  static constexpr double kTickMs = 0.5;
  /// The sum of squared deviations of departure gaps [ms^2] from which on the share is known. The
  /// rounding of arrival times to 1/1024 s then causes an error of 0.1.
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
