// SPDX-License-Identifier: LGPL-2.1-or-later
// Senders, a bottleneck and receivers in simulated time: the whole control loop, which is
// deterministic.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/link/bottleneck.h"
#include "src/rtcp/feedback_generator.h"
#include "src/scream/controller.h"
#include "src/sim/tcp_window.h"

namespace lidar::scream::test {

constexpr Duration kNever = Duration::max();

/// The lowest and the highest useful bitrate of an encoder, on the wire.
struct EncoderBounds {
  DataRate min;
  DataRate max;
};

struct EncodedFrame {
  DataSize size;                        ///< on the wire; 0: the encoder leaves the frame out
  std::optional<EncoderBounds> bounds;  ///< set if they have changed
  /// Frames of the same group are useful only together.
  std::optional<std::uint32_t> group = std::nullopt;
};

/// An encoder that follows its target, and the stream that it feeds.
struct SourceConfig {
  StreamConfig stream;
  double frames_per_second = 50;
  Duration stop_at = kNever;
  /// The source sends no frames between these times of the flow.
  Duration pause_from = kNever, pause_until = kNever;
  double frame_jitter = 0;  ///< frame sizes vary by up to this fraction, uniformly
  /// The encoder's output relative to its target, as a function of the flow's time.
  std::function<double(Duration)> obedience;
  /// Replaces frame_jitter and obedience: returns the next frame for the current target.
  std::function<EncodedFrame(DataRate)> encoder;
};

/// The indices of the links that packets pass through, in order.
using Route = std::vector<std::size_t>;

/// A sender and its receiver. Times are relative to the start of the flow.
struct FlowConfig {
  Parameters parameters;
  Route route{0};
  /// The links that reports pass through. If there are none, reports take `return_delay`.
  Route return_route;
  /// The delay in each direction, in addition to the delay of the links.
  Duration access_delay{0};
  std::vector<SourceConfig> sources{1};
  rtcp::FeedbackConfig feedback;
  Time start{};
  Duration stop_after = kNever;
  bool drop_late = true;
  /// A frame of which a part was sent is dropped when its next packet has waited this long.
  Duration longest_stay = std::chrono::milliseconds(1000);
  /// The time at which the receiver restarts without state, and with another clock epoch.
  Duration receiver_restart = kNever;
  /// The time at which another sender, with new SSRCs, continues the flow.
  Duration sender_restart = kNever;
  /// The time at which sequence numbers jump back by `jump_back`, modulo 2^16.
  Duration sequence_jump = kNever;
  std::uint16_t jump_back = 0;
  /// If false, reports have no arrival times, which RFC 8888 permits.
  bool arrival_times = true;
  /// The time at which the sender gets the signal route-changed.
  Duration route_change = kNever;
  /// The time at which the clocks jump, and the amounts by which they jump.
  Duration clock_jump = kNever;
  Duration sender_jump{0}, receiver_jump{0};
  double receiver_drift = 0;  ///< fraction by which the receiver's clock is too fast
  /// The sender and the receiver stop for up to `stall`, on average every `stall_every`. Packets
  /// still arrive.
  Duration stall{0};
  Duration stall_every = std::chrono::seconds(1);
  Duration wakeup_delay{0};  ///< greatest delay of a wake-up of the pacing thread
};

/// The files that a flow sends one after the other, each over a new connection.
struct FileConfig {
  DataSize shortest, longest;  ///< file sizes are uniformly distributed between these
  Duration mean_pause{0};      ///< pauses are exponentially distributed
};

/// A greedy background flow that starts at the time `start` of the run.
struct TcpConfig {
  TcpKind kind = TcpKind::kCubic;
  Duration start{0};
  Ecn ecn = Ecn::kNotEct;             ///< of Reno and Cubic; Prague always uses ECT(1)
  double slow_start_threshold = 1e9;  ///< [packets]
  Duration stop = kNever;
  Route route = {0};
  /// If set, the flow sends files instead of an endless transfer.
  std::optional<FileConfig> files = std::nullopt;
};

struct SimulationConfig {
  link::BottleneckConfig forward;                  ///< link 0; its delay is the forward delay
  std::vector<link::BottleneckConfig> more_links;  ///< links 1, 2, ...
  Duration return_delay{0};
  double return_loss = 0;
  /// Two out of three packets that are sent between these times are lost.
  Duration loss_from = kNever, loss_until = kNever;
  /// The return path carries no packets between these times.
  Duration return_outage_from = kNever, return_outage_until = kNever;
  /// A change of the route: after `longer_from`, the forward delay is longer by `longer_by`.
  Duration longer_by{0};
  Duration longer_from = kNever;
  Duration duration = std::chrono::seconds(40);
  std::vector<FlowConfig> flows{1};
  std::vector<TcpConfig> others;  ///< their flows follow our flows in the log of packets
  Duration sample_interval = std::chrono::milliseconds(10);
};

struct Percentiles {
  double p50 = 0, p95 = 0, p99 = 0, max = 0;
};
Percentiles Summarise(std::vector<double> values);

struct PacketLog {
  Time sent{}, arrival{};
  double sojourn_ms = 0;  ///< sum over all queues
  int flow = 0;
  int source = 0;
  std::int64_t bytes = 0;
  bool delivered = false;
};

struct Sample {
  Time time{};
  int flow = 0;
  double capacity_mbps = 0;
  Statistics statistics;
  std::vector<DataRate> targets;  ///< of the sources
};

/// A frame, from its encoding to its arrival.
struct FrameLog {
  Time created{};
  int source = 0;
  std::int64_t bytes = 0;  ///< 0: the encoder left the frame out
  int packets = 0;
  int delivered = 0;  ///< packets that have arrived
  Time arrival{};     ///< of the last packet that arrived

  bool complete() const { return packets > 0 && delivered == packets; }
};

struct FlowResult {
  std::vector<FrameLog> frames;
  std::vector<double> frame_latency_ms;
  std::int64_t delivered_bytes = 0;
  std::uint64_t frames_sent = 0, frames_dropped = 0;
  std::uint64_t packets_sent = 0, packets_congestion_lost = 0, packets_random_lost = 0;
  std::int64_t feedback_bytes = 0;
  Statistics statistics;
};

struct TcpResult {
  std::int64_t delivered_bytes = 0;
  std::vector<double> file_s;  ///< duration of each file
  std::uint64_t packets_sent = 0, packets_lost = 0;
  double mean_window = 0;  ///< [packets], of an endless transfer
};

struct SimulationResult {
  std::vector<FlowResult> flows;
  std::vector<TcpResult> others;
  std::vector<PacketLog> packets;
  std::vector<Sample> samples;
  SimulationConfig config;

  double Utilisation(Time from, Time until) const;
  Percentiles QueueDelay(Time from, Time until) const;
  std::int64_t DeliveredBytes(Time from, Time until, int flow = -1, int source = -1) const;
};

SimulationResult Simulate(const SimulationConfig& config);

}  // namespace lidar::scream::test
