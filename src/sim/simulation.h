// SPDX-License-Identifier: LGPL-2.1-or-later
// Senders, a bottleneck and receivers in simulated time: the whole control loop, deterministic.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/link/bottleneck.h"
#include "src/scream/controller.h"
#include "src/scream/feedback/feedback_generator.h"
#include "src/sim/tcp_window.h"

namespace lidar::scream::test {

constexpr Duration kNever = Duration::max();

/// Bitrates that an encoder says it needs and can use, on the wire.
struct EncoderBounds {
  DataRate min;
  DataRate max;
};

struct EncodedFrame {
  DataSize size;                        ///< on the wire; 0: left out
  std::optional<EncoderBounds> bounds;  ///< where they have changed
  /// Frames that are of use together share it.
  std::optional<std::uint32_t> group = std::nullopt;
};

/// An encoder that obeys its target, and the stream that it feeds.
struct SourceConfig {
  StreamConfig stream;
  double frames_per_second = 50;
  Duration stop_at = kNever;
  /// No frame within this time of the flow.
  Duration pause_from = kNever, pause_until = kNever;
  double frame_jitter = 0;  ///< frame sizes vary evenly by up to this fraction
  /// Scales what the encoder puts out against its target, over time since the flow's start.
  std::function<double(Duration)> obedience;
  /// Replaces both: makes the next frame for the target that it has.
  std::function<EncodedFrame(DataRate)> encoder;
};

/// Links of a simulation that packets pass one after the other, by index.
using Route = std::vector<std::size_t>;

/// Times are since the flow's start.
struct FlowConfig {
  Parameters parameters;
  Route route{0};
  /// Links that the reports pass; without any they need `return_delay`.
  Route return_route;
  /// Delay in addition to that of the links, each way.
  Duration access_delay{0};
  std::vector<SourceConfig> sources{1};
  FeedbackConfig feedback;
  Time start{};
  Duration stop_after = kNever;
  bool drop_late = true;
  /// The rest of a frame that began to leave is dropped once its head has waited for so long.
  Duration longest_stay = std::chrono::milliseconds(1000);
  /// The receiver forgets everything, and its clock has another epoch.
  Duration receiver_restart = kNever;
  /// A new sender with other SSRCs takes over.
  Duration sender_restart = kNever;
  /// Sequence numbers go back by so much, or on by the rest of their range.
  Duration sequence_jump = kNever;
  std::uint16_t jump_back = 0;
  /// Reports hold no arrival times (RFC 8888 allows it).
  bool arrival_times = true;
  /// Time at which the sender gets route-changed.
  Duration route_change = kNever;
  /// Clocks are set by so much.
  Duration clock_jump = kNever;
  Duration sender_jump{0}, receiver_jump{0};
  double receiver_drift = 0;  ///< its clock is too fast by this part
  /// The machine stops for up to this, on average so often; packets still arrive.
  Duration stall{0};
  Duration stall_every = std::chrono::seconds(1);
  Duration wakeup_delay{0};  ///< the pacing thread wakes up late by up to this
};

/// Files that a flow sends one after the other, each over a new connection.
struct FileConfig {
  DataSize shortest, longest;  ///< any size between them is as likely
  Duration mean_pause{0};      ///< exponentially distributed
};

/// A greedy background flow, from `start` of the run on.
struct TcpConfig {
  TcpKind kind = TcpKind::kCubic;
  Duration start{0};
  link::Ecn ecn = link::Ecn::kNotEct;  ///< of Reno and Cubic; Prague sends ECT(1)
  double slow_start_threshold = 1e9;   ///< [packets]
  Duration stop = kNever;
  Route route = {0};
  std::optional<FileConfig> files = std::nullopt;  ///< instead of one transfer without an end
};

struct SimulationConfig {
  link::BottleneckConfig forward;                  ///< link 0; its delay is the way there
  std::vector<link::BottleneckConfig> more_links;  ///< 1, 2, ...
  Duration return_delay{0};
  double return_loss = 0;
  /// Two of three packets sent within this time of the run are lost.
  Duration loss_from = kNever, loss_until = kNever;
  /// The way back carries no packet within this time of the run.
  Duration return_outage_from = kNever, return_outage_until = kNever;
  /// A change of route: the way there is longer from then on.
  Duration longer_by{0};
  Duration longer_from = kNever;
  Duration duration = std::chrono::seconds(40);
  std::vector<FlowConfig> flows{1};
  std::vector<TcpConfig> others;  ///< in the packets' log their flows come after ours
  Duration sample_interval = std::chrono::milliseconds(10);
};

struct Percentiles {
  double p50 = 0, p95 = 0, p99 = 0, max = 0;
};
Percentiles Summarise(std::vector<double> values);

struct PacketLog {
  Time sent{}, arrival{};
  double sojourn_ms = 0;  ///< in all queues
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

/// The life of one frame.
struct FrameLog {
  Time created{};
  int source = 0;
  std::int64_t bytes = 0;  ///< 0: the encoder left it out
  int packets = 0;
  int delivered = 0;  ///< of these
  Time arrival{};     ///< of the last one delivered

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
  std::vector<double> file_s;  ///< what each file took
  std::uint64_t packets_sent = 0, packets_lost = 0;
  double mean_window = 0;  ///< [packets], of a transfer without an end
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
