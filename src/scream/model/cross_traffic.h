// SPDX-License-Identifier: LGPL-2.1-or-later
// Beyond the draft: whether other flows use the bottleneck, too, and what it carries in all.
#pragma once
#include <algorithm>
#include <optional>
#include <utility>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {

/// While the bottleneck's queue does not run empty, only what others sent in between comes between
/// the arrivals of our packets, however far apart they left. So the spacing of arrivals grows with
/// that of departures by the others' share of the link. What is left of it is the time that the
/// link takes for one of ours. The pacer lets packets leave a little unevenly for this. Arrival
/// times of reports are coarse, so it takes many packets.
class CrossTraffic {
 public:
  struct Packet {
    Time sent{};
    Time arrival{};
    DataSize size;
  };

  /// `congested`: marks or losses show that there is a queue. Without them jitter, or a clock that
  /// drifts, looks like one, and on an idle link arrivals follow departures as they do beside
  /// others.
  void Add(const Packet& packet, Duration qdelay, bool congested) {
    if (!congested) {
      Skip(packet.sent);
      return;
    }
    // What arrived must not decide which packets count, so the one before shows the queue.
    const double waited_ms = std::min(lately_waited_ms_, waited_ms_);
    waited_ms_ = Ms(qdelay);
    lately_waited_ms_ += (waited_ms_ - lately_waited_ms_) / 4;
    const auto previous = std::exchange(last_, packet);
    if (!previous || packet.sent <= previous->sent || packet.arrival < previous->arrival) return;
    const double sent_ms = Ms(packet.sent - previous->sent);
    const double arrived_ms = Ms(packet.arrival - previous->arrival);
    spacing_ms_ += (sent_ms - spacing_ms_) / 16;
    const bool idle = waited_ms < std::max(sent_ms, kLongestGap * spacing_ms_) + kTickMs;
    const bool alone = share().value_or(1) < kFound;
    unseen_ = alone ? 0 : std::min(unseen_ + Weight(sent_ms), kSure);
    if (idle || arrived_ms > kPauseMs) return;
    const int weight = Weight(Ms(packet.sent - std::exchange(counted_, packet.sent)));
    Count(sent_ms, arrived_ms, static_cast<double>(packet.size.bytes()));
    Decide(weight);
  }
  /// Arrival times of one report are rounded alike, those of two are not.
  void BeginReport() { last_.reset(); }
  /// Stays as it was while packets leave so evenly that they tell nothing.
  bool found() const { return found_; }
  /// The others' share of the link while we send; none while too little is known.
  std::optional<double> share() const {
    if (sent_sent_ < kEvidence) return std::nullopt;
    return sent_arrived_ / sent_sent_;
  }
  /// Behind a queue for long that is not known to be ours alone: either others fill it while our
  /// packets are far apart, so that few tell of them, or reports tell too little.
  bool unseen() const { return unseen_ >= kSure; }
  /// What the link carries for all; as share().
  std::optional<DataRate> link_rate() const {
    const auto share = this->share();
    const double own_ms = arrived_.value - share.value_or(0) * sent_.value;
    if (!share || own_ms <= 0) return std::nullopt;
    return DataRate::BitsPerSecond(bytes_.value * 8e3 / own_ms);
  }

 private:
  /// An average over as many packets as the sums.
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
    // Against the averages of late: the spacing changes with our rate and the link's, too.
    lately_sent_.Add(sent_ms, 1 / kLately);
    lately_arrived_.Add(arrived_ms, 1 / kLately);
    const double sent = sent_ms - lately_sent_.value;
    sent_sent_ += sent * sent - sent_sent_ / kPackets;
    sent_arrived_ += sent * (arrived_ms - lately_arrived_.value) - sent_arrived_ / kPackets;
  }
  /// In milliseconds since the last one: where few packets tell anything, each counts for more.
  static int Weight(double apart_ms) {
    return static_cast<int>(std::clamp(apart_ms, 1.0, kMostWeight));
  }
  /// A start, or a step of the capacity, is over before it is believed.
  void Decide(int weight) {
    const auto share = this->share();
    const bool same = !share || (*share > (found_ ? kGone : kFound)) == found_;
    against_ = same ? 0 : against_ + weight;
    if (against_ < kSure) return;
    found_ = !found_;
    against_ = 0;
  }

  static constexpr double kLately = 8;
  static constexpr double kPackets = 2048;
  static constexpr int kSure = 768;  // packets, or milliseconds between them
  static constexpr double kMostWeight = 10;
  static constexpr Duration kForgotten = std::chrono::seconds(10);
  /// A longer one is a gap of the link, or a clock that was set.
  static constexpr double kPauseMs = 15;
  /// That the pacer leaves, in average gaps.
  static constexpr double kLongestGap = 1.5;
  /// Delays are too long by this on average, as arrival times are rounded.
  static constexpr double kTickMs = 0.5;
  /// In ms^2: arrival times of 1/1024 s leave an error of 0.1 in the share.
  static constexpr double kEvidence = 30;
  static constexpr double kFound = 0.2;
  static constexpr double kGone = 0.15;
  std::optional<Packet> last_;
  Time counted_{};
  double waited_ms_ = 0;         // by the packet before...
  double lately_waited_ms_ = 0;  // ...and by some before it, on average
  double spacing_ms_ = 0;
  double counted_packets_ = 0;
  Average sent_, arrived_, bytes_;
  Average lately_sent_, lately_arrived_;
  double sent_sent_ = 0, sent_arrived_ = 0;  // sums of products
  int unseen_ = 0;                           // in a row while not known to be alone, by weight
  int against_ = 0;                          // in a row that speak against `found_`, by weight
  bool found_ = false;
};

}  // namespace lidar::scream
