// SPDX-License-Identifier: LGPL-2.1-or-later
// A sender with its sources, and its receiver, in simulated time.
#pragma once
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "src/base/target_notifier.h"
#include "src/sim/network.h"
#include "src/sim/simulation.h"

namespace lidar::scream::test {

class Flow {
 public:
  Flow(const FlowConfig& config, int index, std::uint64_t seed);

  Time NextEvent(Time now);
  void Step(Time now, const SimulationConfig& sim, link::Random* loss, Network* network);
  void OnArrival(const WirePacket& packet, const link::Outcome& outcome);
  Duration access_delay() const { return config_.access_delay; }
  FlowResult Finish(Time now);
  Statistics statistics(Time now) const { return controller_->statistics(ToSender(now)); }
  std::vector<DataRate> targets() const;

 private:
  /// An encoder, its stream and its queue.
  struct SourceState {
    StreamId stream = 0;
    std::uint32_t ssrc = 0;
    std::uint16_t seq = 65000;  // close to the wrap, which is then early in a run
    Time next_frame{};
    std::deque<WirePacket> queue;
    std::deque<Time> queued;  // queuing times of the packets in `queue`
    TargetNotifier notifier;
    DataRate told;  // last target that was sent to the encoder
  };

  void StartSender();
  void Happen(Time now);
  /// The clocks of the two ends, which a run may change.
  Time ToSender(Time t) const { return t + sender_offset_; }
  Time ToReceiver(Time t) const {
    return t + receiver_offset_ + FromSeconds(Seconds(t - config_.start) * config_.receiver_drift);
  }
  Time FromReceiver(Time t) const {
    if (t == Time::max()) return t;
    const double d = config_.receiver_drift;
    const Time set_right = t - receiver_offset_;
    return set_right - FromSeconds(Seconds(set_right - config_.start) * d / (1 + d));
  }
  static Time Back(Time t, Duration offset) { return t == Time::max() ? t : t - offset; }
  std::optional<Time> Wake(Time now);
  bool Stalled(Time now);
  void MakeFrame(Time now, std::size_t index);
  EncodedFrame Encode(Time now, std::size_t index);
  void Packetize(Time now, SourceState* source, const EncodedFrame& encoded, FrameLog* frame);
  void TellEncoders(Time now);
  void DropLate(Time now);
  std::size_t StuckPackets(const SourceState& source, Time now) const;
  void Send(Time now, Network* network);
  void Report(Time now, const SimulationConfig& sim, link::Random* loss, Network* network);
  SourceState* Owner(StreamId stream);

  FlowConfig config_;
  std::unique_ptr<Controller> controller_;
  rtcp::FeedbackGenerator generator_;
  rtcp::CcfbParser parser_;
  link::Random random_;
  int index_;
  std::uint32_t generation_ = 0;  // number of restarts of the sender
  std::vector<SourceState> sources_;
  Time asked_{};
  Time wake_{};
  Time stalled_until_{};
  Time next_stall_{};
  std::uint32_t epoch_ = 0;
  Duration sender_offset_{0}, receiver_offset_{0};
  std::multimap<Time, std::vector<std::uint8_t>> reports_;
  FlowResult result_;
};

}  // namespace lidar::scream::test
