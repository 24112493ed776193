// SPDX-License-Identifier: LGPL-2.1-or-later
// Beyond the draft: whether other flows use the bottleneck, too.
#pragma once
#include <optional>
#include <utility>

#include "src/base/time.h"

namespace lidar::scream {

/// While the bottleneck's queue does not run empty, only what others sent in between comes between
/// the arrivals of our packets, however far apart they left. So the spacing of arrivals grows with
/// that of departures by the others' share of the link. Arrival times of reports are
/// coarse, so it takes many packets.
class CrossTraffic {
 public:
  /// `congested`: marks or losses show that there is a queue. Without them jitter, or a clock that
  /// drifts, looks like one, and on an idle link arrivals follow departures as they do beside
  /// others.
  void Add(Time sent, Time arrival, Duration qdelay, bool congested) {
    if (!congested) {
      Skip(sent);
      return;
    }
    const auto previous = std::exchange(last_, Packet{sent, arrival});
    if (!previous || sent <= previous->sent || arrival < previous->arrival) return;
    // A packet that waited for less may have met an idle link.
    if (sent - previous->sent > kPause || arrival - previous->arrival > qdelay) return;
    counted_ = sent;
    Count(1e3 * Seconds(sent - previous->sent), 1e3 * Seconds(arrival - previous->arrival));
  }
  /// The next packet has no neighbour: there was a gap, or a clock was set.
  void Break() { last_.reset(); }
  /// Stays as it was while packets leave so evenly that they tell nothing.
  bool found() const { return found_; }
  /// The others' share of the link; none while too little is known.
  std::optional<double> share() const {
    if (sent_sent_ < kEvidence) return std::nullopt;
    return sent_arrived_ / sent_sent_;
  }

 private:
  void Skip(Time sent) {
    last_.reset();
    if (sent - counted_ > kForgotten) *this = CrossTraffic();
  }
  struct Packet {
    Time sent{};
    Time arrival{};
  };

  /// Against the averages of late: the spacing changes with our rate and the link's, too.
  void Count(double sent_ms, double arrived_ms) {
    mean_sent_ += (sent_ms - mean_sent_) / kLately;
    mean_arrived_ += (arrived_ms - mean_arrived_) / kLately;
    const double sent = sent_ms - mean_sent_;
    sent_sent_ += sent * sent - sent_sent_ / kPackets;
    sent_arrived_ += sent * (arrived_ms - mean_arrived_) - sent_arrived_ / kPackets;
    Decide();
  }
  /// A start, or a step of the capacity, is over before it is believed.
  void Decide() {
    const auto share = this->share();
    const bool same = !share || (*share > (found_ ? kGone : kFound)) == found_;
    against_ = same ? 0 : against_ + 1;
    if (against_ < kSure) return;
    found_ = !found_;
    against_ = 0;
  }

  static constexpr double kLately = 64;
  static constexpr double kPackets = 2048;
  static constexpr int kSure = 1024;  // packets
  static constexpr Duration kForgotten = std::chrono::seconds(10);
  static constexpr Duration kPause = std::chrono::milliseconds(15);
  /// In ms^2: arrival times of 1/1024 s leave an error of 0.1 in the share.
  static constexpr double kEvidence = 30;
  static constexpr double kFound = 0.3;
  static constexpr double kGone = 0.2;
  std::optional<Packet> last_;
  Time counted_{};
  double mean_sent_ = 0, mean_arrived_ = 0;
  double sent_sent_ = 0, sent_arrived_ = 0;  // sums of products
  int against_ = 0;                          // packets in a row that speak against `found_`
  bool found_ = false;
};

}  // namespace lidar::scream
