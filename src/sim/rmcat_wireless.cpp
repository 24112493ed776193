// SPDX-License-Identifier: LGPL-2.1-or-later
// The cases of RFC 8869, which uses system simulators for radios. Here a cell is modelled as a
// capacity over time. Wi-Fi is modelled as a channel that both directions share, and that sends
// packets in aggregates.

#include "src/link/random.h"
#include "src/link/trace_maker.h"
#include "src/sim/rmcat.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

constexpr Duration kWirelessOneWay = std::chrono::milliseconds(50);
constexpr Duration kWirelessFifo = std::chrono::milliseconds(300);
constexpr Duration kAggregate = std::chrono::milliseconds(4);
constexpr double kAirMbps = 20;

link::BottleneckConfig Link(link::Capacity capacity, std::uint64_t seed) {
  link::BottleneckConfig link;
  link.origin = kStart;
  link.capacity = std::move(capacity);
  link.delay = kWirelessOneWay;
  link.limit.time = kWirelessFifo;
  link.seed = seed;
  return link;
}

RmcatCase Wireless(const char* section, const std::string& name, const std::string& description,
                   link::Capacity capacity) {
  RmcatCase c;
  c.section = std::string("RFC 8869, ") + section;
  c.name = std::string("rfc8869_") + section + "_" + name;
  c.description = description;
  c.config.forward = Link(std::move(capacity), 1);
  c.config.return_delay = kWirelessOneWay;
  c.config.duration = 120s;
  c.config.flows.clear();
  c.forward.clear();
  c.from = 10s;
  c.until = 119s;
  return c;
}

/// Returns the capacity of a cell that serves all its users equally, while users come and go.
link::Capacity SharedCell(double mbps, double mean_users) {
  link::Random random(7);
  std::string text, error;
  double users = mean_users;
  for (int second = 0; second < 120; ++second) {
    if (random.Chance(0.3)) users += random.Uniform() < mean_users / (users + mean_users) ? 1 : -1;
    users = std::max(0.0, users);
    text += std::to_string(second) + " " + std::to_string(mbps / (1 + users)) + "\n";
  }
  return *link::Capacity::ParseTrace(text, false, &error);
}

RmcatCase Cellular(const char* section, const char* name, const std::string& description,
                   link::Capacity capacity, const Parameters& p) {
  RmcatCase c = Wireless(section, name, description, std::move(capacity));
  c.config.forward.path.jitter = 8ms;  // due to retransmissions of the radio
  c.config.forward.limit = {Mbps(2) * kWirelessFifo, Duration::max()};
  c.config.flows.push_back(RmcatVideo(p, 0s, 5));
  c.forward = {0};
  return c;
}

link::Capacity Drive(double mbps) {
  link::DriveTraceConfig drive;
  drive.mean = Mbps(mbps);
  drive.in_gaps = Mbps(0.05);
  drive.duration = 120s;
  std::string error;
  return *link::Capacity::ParseTrace(MakeDriveTrace(drive), true, &error);
}

/// A case with a wired bottleneck of 1 Mbit/s in each direction. The wireless link behind it is
/// faster.
RmcatCase WiredBottleneck(const std::string& name, const std::string& description,
                          const Parameters& p) {
  RmcatCase c = Wireless("4.1", name, description, link::Capacity::Constant(Mbps(1)));
  c.config.forward.path.burst_interval = kAggregate;
  c.config.more_links.push_back(c.config.forward);
  c.config.more_links.back().seed = 2;
  for (std::size_t i = 0; i < 2; ++i) {
    c.config.flows.push_back(RmcatVideo(p));
    c.config.flows.back().route = {i};
    c.config.flows.back().return_route = {1 - i};
  }
  c.forward = {0};
  return c;
}

/// WiredBottleneck() with a background flow on link `on` from 40 to 80 s.
RmcatCase BesideBackground(bool tcp, std::size_t on, const Parameters& p) {
  const std::string way = on == 0 ? "same_way" : "other_way";
  RmcatCase c =
      WiredBottleneck((tcp ? "tcp_" : "cbr_") + way,
                      std::string("media both ways, ") + (tcp ? "Cubic" : "0.3 Mbit/s of CBR") +
                          " beside them from 40 to 80 s",
                      p);
  if (tcp) {
    TcpConfig other;
    other.start = 40s;
    other.stop = 80s;
    other.route = {on};
    c.config.others.push_back(other);
    return c;
  }
  // A flow of constant rate is modelled by the capacity that it leaves to the other flows.
  std::string error;
  const auto less = *link::Capacity::ParseTrace("0 1\n40 0.7\n80 1\n", false, &error);
  (on == 0 ? c.config.forward : c.config.more_links[0]).capacity = less;
  return c;
}

struct Air {
  int flows = 0;
  int tcp = 0;
  double cbr_mbps = 0;
};

/// A case in which all flows and their reports, in both directions, share one queue and the
/// airtime.
RmcatCase WirelessBottleneck(const std::string& name, const std::string& description,
                             const Air& air, const Parameters& p) {
  RmcatCase c = Wireless("4.2", name, description, link::Capacity::Constant(Mbps(kAirMbps)));
  if (air.cbr_mbps > 0) {
    std::string error;
    const std::string less = std::to_string(kAirMbps - air.cbr_mbps);
    c.config.forward.capacity =
        *link::Capacity::ParseTrace("0 20\n40 " + less + "\n80 20\n", false, &error);
  }
  c.config.forward.path.burst_interval = kAggregate;
  c.config.forward.path.jitter = 3ms;  // due to the backoff before each transmission
  for (int i = 0; i < air.flows; ++i) {
    c.config.flows.push_back(RmcatVideo(p, i * 103ms));
    c.config.flows.back().return_route = {0};
    c.forward.push_back(i);
  }
  for (int i = 0; i < air.tcp; ++i) {
    TcpConfig other;
    other.start = 40s;
    other.stop = 80s;
    c.config.others.push_back(other);
  }
  return c;
}

}  // namespace

std::vector<RmcatCase> WirelessCases(const Parameters& p) {
  std::vector<RmcatCase> all;
  all.push_back(Cellular("3.1", "varying_load", "a cell of 12 Mbit/s that users share",
                         SharedCell(12, 4), p));
  all.push_back(Cellular("3.2", "bad_coverage", "a drive at 2 Mbit/s with gaps", Drive(2), p));
  all.push_back(WiredBottleneck("both_ways", "media both ways", p));
  all.push_back(all.back());
  all.back().name = "rfc8869_4.1_one_way";
  all.back().description = "media one way";
  all.back().config.flows.resize(1);
  for (const bool tcp : {false, true})
    for (const std::size_t on : {0U, 1U}) all.push_back(BesideBackground(tcp, on, p));
  for (const int n : {16, 24, 32})
    all.push_back(
        WirelessBottleneck("flows_" + std::to_string(n), std::to_string(n) + " flows", {n}, p));
  all.push_back(WirelessBottleneck("flows_24_cbr", "24 flows and 2.4 Mbit/s of CBR from 40 to 80 s",
                                   {24, 0, 2.4}, p));
  all.push_back(
      WirelessBottleneck("flows_24_tcp", "24 flows and four Cubics from 40 to 80 s", {24, 4}, p));
  return all;
}

}  // namespace lidar::scream::test
