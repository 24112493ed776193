// SPDX-License-Identifier: LGPL-2.1-or-later
// The cases of RFC 8867: a video of 0.15 to 1.5 Mbit/s, a delay of 50 ms each way, a FIFO of 300
// ms, and jitter of up to 30 ms.
#include <utility>

#include "src/sim/rmcat.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

constexpr Duration kOneWay = std::chrono::milliseconds(50);
constexpr Duration kFifo = std::chrono::milliseconds(300);
constexpr Duration kJitter = std::chrono::milliseconds(30);

/// The capacity from the time `at_s` on.
struct CapacityStep {
  double at_s = 0;
  double mbps = 0;
};

link::Capacity Pattern(const std::vector<CapacityStep>& steps) {
  std::string text, error;
  for (const CapacityStep& s : steps)
    text += std::to_string(s.at_s) + " " + std::to_string(s.mbps) + "\n";
  return *link::Capacity::ParseTrace(text, false, &error);
}

link::BottleneckConfig DropTail(link::Capacity capacity, std::uint64_t seed = 1) {
  link::BottleneckConfig link;
  link.origin = kStart;
  link.capacity = std::move(capacity);
  link.delay = kOneWay;
  link.limit.time = kFifo;
  link.path.jitter = kJitter;  // RFC 8868, 4.5: a Gaussian of 5 ms, bounded
  link.path.jitter_draws = 3;
  link.seed = seed;
  return link;
}

RmcatCase Case(const char* section, const char* name, const std::string& description,
               link::Capacity capacity, Duration duration) {
  RmcatCase c;
  c.section = std::string("RFC 8867, ") + section;
  c.name = std::string("rfc8867_") + section + "_" + name;
  c.description = description;
  c.config.forward = DropTail(std::move(capacity));
  c.config.return_delay = kOneWay;
  c.config.duration = duration;
  c.config.flows.clear();
  c.from = 5s;
  c.until = duration - 1s;
  return c;
}

void AddFlow(FlowConfig flow, RmcatCase* c) {
  c->config.flows.push_back(std::move(flow));
  c->forward.clear();
  for (std::size_t i = 0; i < c->config.flows.size(); ++i)
    c->forward.push_back(static_cast<int>(i));
}

const std::vector<CapacityStep> kOnePattern = {{0, 1}, {40, 2.5}, {60, 0.6}, {80, 1}};

RmcatCase CongestedFeedback(const Parameters& p) {
  RmcatCase c = Case("5.3", "congested_feedback",
                     "media both ways; 2, 1, 0.5, 2 Mbit/s there, 2, 0.8, 2 back",
                     Pattern({{0, 2}, {20, 1}, {40, 0.5}, {60, 2}}), 100s);
  c.config.more_links.push_back(DropTail(Pattern({{0, 2}, {35, 0.8}, {70, 2}}), 2));
  AddFlow(RmcatVideo(p), &c);
  AddFlow(RmcatVideo(p), &c);
  c.config.flows[0].return_route = {1};
  c.config.flows[1].route = {1};
  c.config.flows[1].return_route = {0};
  c.forward = {0};
  return c;
}

/// A case with three flows that start 20 s apart.
RmcatCase ThreeFlows(const char* section, const char* name, const std::string& description,
                     const Parameters& p) {
  RmcatCase c = Case(section, name, description, link::Capacity::Constant(Mbps(3.5)), 120s);
  for (const Duration start : {0s, 20s, 40s}) AddFlow(RmcatVideo(p, start), &c);
  c.from = 60s;
  return c;
}

RmcatCase RoundTripFairness(const Parameters& p) {
  RmcatCase c = Case("5.5", "rtt_fairness", "five flows of 10, 25, 50, 100 and 150 ms each way",
                     link::Capacity::Constant(Mbps(4)), 300s);
  c.config.forward.delay = c.config.return_delay = 10ms;
  Duration start = 0s;
  for (const Duration one_way : {10ms, 25ms, 50ms, 100ms, 150ms}) {
    AddFlow(RmcatVideo(p, start), &c);
    c.config.flows.back().access_delay = one_way - 10ms;
    start += 10s;
  }
  c.from = 60s;
  return c;
}

RmcatCase LongTcp(const Parameters& p, Duration fifo) {
  const std::string ms = std::to_string(fifo / 1ms);
  RmcatCase c =
      Case("5.6", ("long_tcp_fifo_" + ms + "ms").c_str(),
           "beside one Cubic, a FIFO of " + ms + " ms", link::Capacity::Constant(Mbps(2)), 120s);
  c.config.forward.limit.time = fifo;
  AddFlow(RmcatVideo(p, 5s), &c);
  c.config.others = {{TcpKind::kCubic}};
  c.from = 20s;
  return c;
}

RmcatCase ShortTcp(const Parameters& p) {
  RmcatCase c = Case("5.7", "short_tcp", "two flows beside ten that send files of 0.1 to 1 MB",
                     link::Capacity::Constant(Mbps(2)), 300s);
  AddFlow(RmcatVideo(p), &c);
  AddFlow(RmcatVideo(p, 5s), &c);
  for (int i = 0; i < 10; ++i) {
    TcpConfig files;
    files.files = FileConfig{DataSize::Bytes(100'000), DataSize::Bytes(1'000'000), 10s};
    c.config.others.push_back(files);
  }
  c.from = 10s;
  return c;
}

/// The case of RFC 8867, 5.8, with three flows. The measurement begins when the first flow has
/// resumed.
RmcatCase PauseAndResume(const Parameters& p) {
  RmcatCase c =
      ThreeFlows("5.8", "pause_resume", "three flows, the first pauses from 40 to 60 s", p);
  c.config.flows[0].sources[0].pause_from = 40s;
  c.config.flows[0].sources[0].pause_until = 60s;
  c.from = 65s;
  return c;
}

RmcatCase Priorities(const Parameters& p) {
  RmcatCase c = Case("6.1", "priority", "two streams of one sender, at priorities of 2 and 1",
                     link::Capacity::Constant(Mbps(1.5)), 60s);
  FlowConfig flow = RmcatVideo(p);
  flow.sources.push_back(flow.sources[0]);
  flow.sources[0].stream.priority = 2;
  AddFlow(flow, &c);
  return c;
}

/// A case in which the first flow passes through both links, and each other flow through one.
RmcatCase TwoBottlenecks(const Parameters& p) {
  RmcatCase c =
      Case("6.3", "two_bottlenecks", "one flow over two links, each with a flow of its own",
           link::Capacity::Constant(Mbps(2)), 120s);
  c.config.forward.delay = 25ms;
  c.config.more_links.push_back(DropTail(link::Capacity::Constant(Mbps(2)), 2));
  c.config.more_links.back().delay = 25ms;
  for (int i = 0; i < 3; ++i) AddFlow(RmcatVideo(p), &c);
  c.config.flows[0].route = {0, 1};
  c.config.flows[2].route = {1};
  c.forward = {0, 1};
  c.from = 30s;
  return c;
}

}  // namespace

std::vector<RmcatCase> WiredCases(const Parameters& p) {
  std::vector<RmcatCase> all;
  all.push_back(
      Case("5.1", "variable_capacity", "1, 2.5, 0.6, 1 Mbit/s", Pattern(kOnePattern), 100s));
  AddFlow(RmcatVideo(p), &all.back());
  all.push_back(Case("5.2", "two_flows_variable_capacity", "two flows; 4, 2, 3.5, 1, 2 Mbit/s",
                     Pattern({{0, 4}, {25, 2}, {50, 3.5}, {75, 1}, {100, 2}}), 125s));
  AddFlow(RmcatVideo(p), &all.back());
  AddFlow(RmcatVideo(p), &all.back());
  all.push_back(CongestedFeedback(p));
  all.push_back(ThreeFlows("5.4", "three_flows", "three flows that start 20 s apart", p));
  all.push_back(RoundTripFairness(p));
  all.push_back(LongTcp(p, kFifo));
  all.push_back(LongTcp(p, 1000ms));
  all.push_back(ShortTcp(p));
  all.push_back(PauseAndResume(p));
  all.push_back(Priorities(p));
  all.push_back(
      Case("6.2", "ecn", "5.1 with marks from 2 to 10 ms of queue", Pattern(kOnePattern), 100s));
  AddFlow(RmcatVideo(p), &all.back());
  all.back().config.forward.aqm.kind = link::AqmConfig::Kind::kRamp;
  all.push_back(TwoBottlenecks(p));
  return all;
}

}  // namespace lidar::scream::test
