// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides whether packets are lost because a queue is full, or independently of the queue.
#pragma once
#include <algorithm>
#include <deque>

#include "src/base/time.h"

namespace lidar::scream {

/// A radio link loses packets at any length of the queue, whereas a full queue loses the packets
/// that overflow it. The rank of a loss is the fraction of recent packet pairs that waited less
/// than the two packets around the loss. The mean rank is one half if losses are random. It is
/// nearly one if a full queue causes the losses, however short this queue is.
class LossContext {
 public:
  void OnAcked(Time sent, Duration qdelay) {
    recent_.push_back({sent, qdelay});
    if (recent_.size() > kRecent) recent_.pop_front();
  }
  void OnLost(Time sent) {
    if (recent_.size() < kRecent / 4) return;
    rank_ += (Rank(QdelayAround(sent)) - rank_) * kGain;
    losses_ = std::min(losses_ + 1, kKnownLosses);
  }
  /// Returns true if losses occur at a full queue.
  bool AtFullQueue() const { return losses_ >= kKnownLosses && rank_ > kFull; }

 private:
  struct Packet {
    Time sent{};
    Duration qdelay{0};
  };

  Duration LongerOfPair(std::size_t second) const {
    return std::max(recent_[second - 1].qdelay, recent_[second].qdelay);
  }
  /// Returns the longer delay of the two packets that were sent just before and just after the
  /// loss. If one of them is missing, uses the two nearest packets.
  Duration QdelayAround(Time sent) const {
    const auto after = std::find_if(recent_.begin(), recent_.end(),
                                    [sent](const Packet& p) { return p.sent >= sent; });
    const auto index = static_cast<std::size_t>(after - recent_.begin());
    return LongerOfPair(std::clamp<std::size_t>(index, 1, recent_.size() - 1));
  }
  /// Returns the rank of `qdelay` from 0 to 1: the fraction of the recent pairs of packets whose
  /// longer delay is below `qdelay`. `qdelay` comes from QdelayAround(), which also returns the
  /// longer delay of a pair.
  double Rank(Duration qdelay) const {
    double below = 0;
    for (std::size_t i = 1; i < recent_.size(); ++i) {
      const Duration longer = LongerOfPair(i);
      below += longer < qdelay ? 1 : longer == qdelay ? 0.5 : 0;
    }
    return below / static_cast<double>(recent_.size() - 1);
  }

  static constexpr std::size_t kRecent = 256;
  static constexpr double kGain = 1.0 / 16;
  static constexpr int kKnownLosses = 6;
  static constexpr double kFull = 0.7;
  std::deque<Packet> recent_;
  double rank_ = 0.5;
  int losses_ = 0;
};

}  // namespace lidar::scream
