// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/rmcat.h"

#include <algorithm>
#include <cmath>

#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

constexpr Duration kRateBin = std::chrono::milliseconds(200);  // RFC 8868, 3

double MegabitsPerSecond(double bytes, Duration time) { return bytes * 8 / 1e6 / Seconds(time); }

/// Returns the bytes of a flow in each bin of the time that is measured.
std::vector<double> Bins(const RmcatCase& c, const SimulationResult& result, int flow) {
  const Time from = c.config.forward.origin + c.from;
  std::vector<double> bins(static_cast<std::size_t>((c.until - c.from) / kRateBin));
  for (const PacketLog& p : result.packets) {
    if (!p.delivered || p.flow != flow || p.arrival < from) continue;
    const auto bin = static_cast<std::size_t>((p.arrival - from) / kRateBin);
    if (bin < bins.size()) bins[bin] += static_cast<double>(p.bytes);
  }
  return bins;
}

double Sum(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum;
}

double Variation(const std::vector<double>& values) {
  const double mean = Sum(values) / static_cast<double>(values.size());
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size())) / std::max(1.0, mean);
}

bool Contains(const std::vector<int>& flows, int flow) {
  return std::find(flows.begin(), flows.end(), flow) != flows.end();
}

/// Returns true if `flow` is a background flow on link 0.
bool OthersOnLink0(const RmcatCase& c, int flow) {
  const auto ours = static_cast<int>(c.config.flows.size());
  return flow >= ours && c.config.others[static_cast<std::size_t>(flow - ours)].route.front() == 0;
}

/// Returns the number of bytes that link 0 can carry and its flows can use. Background flows can
/// use the whole capacity, unless they send files.
double Usable(const RmcatCase& c) {
  double most = 0;
  for (const int flow : c.forward)
    for (const SourceConfig& s : c.config.flows[static_cast<std::size_t>(flow)].sources)
      most += s.stream.max_bitrate.bits_per_second();
  const bool greedy = std::any_of(c.config.others.begin(), c.config.others.end(),
                                  [](const TcpConfig& t) { return !t.files; });
  if (greedy) most = 1e12;
  double bytes = 0;
  for (Duration t = c.from; t < c.until; t += kRateBin) {
    const auto link =
        static_cast<double>(c.config.forward.capacity.Between(t, t + kRateBin).bytes());
    bytes += std::min(link, most / 8 * Seconds(kRateBin));
  }
  return bytes;
}

void MeasurePackets(const RmcatCase& c, const SimulationResult& result, RmcatMetrics* m) {
  const Time from = c.config.forward.origin + c.from;
  const Time until = c.config.forward.origin + c.until;
  std::vector<double> queue_ms;
  double lost = 0, packets = 0, used = 0;
  for (const PacketLog& p : result.packets) {
    if (p.sent < from || p.sent >= until) continue;
    const bool forward = Contains(c.forward, p.flow);
    const bool ours = p.flow < static_cast<int>(result.flows.size());
    if (p.delivered && (forward || OthersOnLink0(c, p.flow))) used += static_cast<double>(p.bytes);
    if (!ours) continue;
    ++packets;
    lost += p.delivered ? 0 : 1;
    if (forward && p.delivered) queue_ms.push_back(p.sojourn_ms);
  }
  m->loss = lost / std::max(1.0, packets);
  m->queue_ms = Summarise(std::move(queue_ms));
  m->utilisation = used / Usable(c);
}

void MeasureFlows(const RmcatCase& c, const SimulationResult& result, RmcatMetrics* m) {
  const Time from = c.config.forward.origin + c.from;
  const Time until = c.config.forward.origin + c.until;
  const auto n = static_cast<double>(c.forward.size());
  double sum = 0, squares = 0, frames = 0;
  std::vector<double> latency_ms;
  for (const int flow : c.forward) {
    const std::vector<double> bins = Bins(c, result, flow);
    const double bytes = Sum(bins);
    sum += bytes;
    squares += bytes * bytes;
    m->variation += Variation(bins) / n;
    for (const FrameLog& f : result.flows[static_cast<std::size_t>(flow)].frames) {
      if (f.created < from || f.created >= until) continue;
      ++frames;
      if (f.complete()) latency_ms.push_back(Milliseconds(f.arrival - f.created));
    }
  }
  m->jain = sum * sum / std::max(1.0, squares * n);
  m->media_mbps = MegabitsPerSecond(sum / n, c.until - c.from);
  m->frame_ms = Summarise(std::move(latency_ms));
  double dropped = 0, all = 0, reports = 0, media = 0;
  for (const FlowResult& flow : result.flows) {
    dropped += static_cast<double>(flow.frames_dropped);
    all += static_cast<double>(flow.frames.size());
    reports += static_cast<double>(flow.feedback_bytes);
    media += static_cast<double>(flow.delivered_bytes);
  }
  m->dropped = dropped / std::max(1.0, all);
  m->feedback = reports / std::max(1.0, media);
}

void MeasureOthers(const RmcatCase& c, const SimulationResult& result, RmcatMetrics* m) {
  double files = 0, seconds = 0;
  for (std::size_t i = 0; i < result.others.size(); ++i) {
    const TcpConfig& config = c.config.others[i];
    const Duration from = std::max(c.from, config.start);
    const Duration until = std::min(c.until, config.stop);
    const Time origin = c.config.forward.origin;
    m->others_mbps +=
        MegabitsPerSecond(
            static_cast<double>(result.DeliveredBytes(origin + from, origin + until,
                                                      static_cast<int>(result.flows.size() + i))),
            until - from) /
        static_cast<double>(result.others.size());
    files += static_cast<double>(result.others[i].file_s.size());
    seconds += Sum(result.others[i].file_s);
  }
  m->file_s = seconds / std::max(1.0, files);
}

}  // namespace

FlowConfig RmcatVideo(const Parameters& parameters, Duration start, double max_mbps) {
  FlowConfig flow;
  flow.parameters = parameters;
  flow.start = kStart + start;
  SourceConfig& source = flow.sources[0];
  source.frames_per_second = 30;
  source.frame_jitter = 0.1;
  source.stream.min_bitrate = Mbps(0.15);
  source.stream.start_bitrate = Mbps(0.3);
  source.stream.max_bitrate = Mbps(max_mbps);
  return flow;
}

RmcatMetrics Measure(const RmcatCase& c, const SimulationResult& result) {
  RmcatMetrics m;
  MeasurePackets(c, result, &m);
  MeasureFlows(c, result, &m);
  MeasureOthers(c, result, &m);
  if (c.config.flows.front().sources.size() == 2) {
    const Time origin = c.config.forward.origin;
    const auto bytes = [&](int source) {
      return static_cast<double>(
          result.DeliveredBytes(origin + c.from, origin + c.until, 0, source));
    };
    m.stream_ratio = bytes(0) / std::max(1.0, bytes(1));
  }
  return m;
}

}  // namespace lidar::scream::test
