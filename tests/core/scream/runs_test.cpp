// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that runs of the whole control loop match the golden files.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "src/sim/scenarios.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

using link::AqmConfig;
using link::Capacity;

struct Run {
  const char* name;
  SimulationConfig config;
};
void PrintTo(const Run& run, std::ostream* out) { *out << run.name; }

SimulationConfig Named(const char* name, const Parameters& parameters = {}) {
  SimulationConfig config = FindScenario(name, parameters)->config;
  config.duration = 12s;
  return config;
}

/// Returns a source of slices. Eight slices are one scan, which takes a tenth of a second. The
/// slices of a scan belong to the same group.
SourceConfig Slices(const StreamConfig& stream) {
  SourceConfig source;
  source.stream = stream;
  source.frames_per_second = 80;
  source.encoder = [slice = 0U](DataRate target) mutable {
    const DataSize size = target * Duration(12500us);
    return EncodedFrame{size * (slice % 8 == 3 ? 1.3 : 0.95), {}, slice++ / 8};
  };
  return source;
}

SimulationConfig ChangingLink() {
  SimulationConfig config = Named("frames_20M_rtt25");
  config.forward.capacity = Capacity::Steps({Mbps(20), Mbps(5), Mbps(14)}, std::chrono::seconds(4));
  config.forward.capacity.AddOutage(2s, 2100ms);
  config.forward.capacity.AddOutage(9s, 9400ms);
  config.forward.path.jitter = 1ms;
  config.forward.path.reorder = 0.002;
  config.flows[0].sources[0].frame_jitter = 0.2;
  config.flows[0].wakeup_delay = 2ms;
  return config;
}

SimulationConfig LossyFifo() {
  SimulationConfig config = Named("slices_8M_fifo100_notect");
  config.forward.loss = 0.01;
  config.loss_from = 6s;
  config.loss_until = 6100ms;
  config.flows[0].sources = {Slices({1, Mbps(0.5), Mbps(2), Mbps(30), Mbps(3)})};
  return config;
}

SimulationConfig LossyMarking() {
  SimulationConfig config = Named("frames_20M_loss1.0");
  config.forward.path.reorder = 0.01;
  config.loss_from = 5s;
  config.loss_until = 5200ms;
  return config;
}

SimulationConfig Outages() {
  SimulationConfig config = Named("frames_8M_rtt40");
  config.forward.capacity.AddOutage(3s, 6500ms);
  config.forward.limit.bytes = DataSize::Bytes(60000);
  config.return_outage_from = 9s;
  config.return_outage_until = 10s;
  config.return_loss = 0.1;
  config.flows[0].sources[0].stream.needed_bitrate = Mbps(1.5);
  return config;
}

SimulationConfig SeldomReports() {
  Parameters parameters;
  parameters.feedback_interval = 300ms;
  parameters.extensions.gaps = false;
  SimulationConfig config = Named("frames10_8M_rtt40", parameters);
  config.forward.capacity.AddOutage(6s, 7500ms);
  config.flows[0].feedback.report_on_ce_change = false;
  config.flows[0].feedback.feedback_interval = 300ms;
  config.flows[0].feedback.packets_per_feedback = 200;
  config.flows[0].feedback.feedback_fraction = 0;
  return config;
}

SimulationConfig ManyStreams() {
  Parameters parameters;
  parameters.max_total_bitrate = Mbps(9);
  SimulationConfig config = Named("frames_8M_rtt40", parameters);
  config.forward.capacity = Capacity::Steps({Mbps(12), Mbps(6)}, std::chrono::seconds(5));
  SourceConfig frames;
  frames.stream = {1, Mbps(0.2), Mbps(1), Mbps(4)};
  frames.frames_per_second = 25;
  frames.obedience = [](Duration t) { return t > 7s && t < 9s ? 6 : 0.9; };
  SourceConfig audio;
  audio.stream = {1, Mbps(0.1), Mbps(0.1), Mbps(0.15), Mbps(0), true};
  audio.stop_at = 9s;
  config.flows[0].sources = {Slices({3, Mbps(0.5), Mbps(2), Mbps(30), Mbps(2)}), frames, audio};
  return config;
}

SimulationConfig Clocks() {
  SimulationConfig config = Named("frames_8M_rtt40");
  FlowConfig& flow = config.flows[0];
  flow.clock_jump = 3s;
  flow.sender_jump = -1h;
  flow.receiver_jump = 1h;
  flow.receiver_restart = 6s;
  flow.sequence_jump = 8s;
  flow.jump_back = 1000;
  flow.stall = 700ms;
  flow.stall_every = 4s;
  return config;
}

SimulationConfig StallsInGaps() {
  SimulationConfig config = Named("frames_8M_rtt40");
  config.forward.capacity.AddOutage(3s, 4500ms);
  config.forward.capacity.AddOutage(7s, 8s);
  config.flows[0].stall = 1500ms;
  config.flows[0].stall_every = 1s;
  return config;
}

SimulationConfig AnotherRoute() {
  SimulationConfig config = Named("frames_20M_rtt25");
  config.forward.capacity.AddOutage(3800ms, 4200ms);
  config.flows[0].route_change = 4s;
  config.longer_by = 30ms;
  config.longer_from = 4s;
  config.flows[0].sender_restart = 9s;
  return config;
}

SimulationConfig LittleToSend() {
  SimulationConfig config = Named("frames_20M_rtt25");
  SourceConfig& source = config.flows[0].sources[0];
  source.frames_per_second = 25;
  source.stream.max_bitrate = Mbps(18);
  source.encoder = [](DataRate) { return EncodedFrame{DataSize::Bytes(12000), {}}; };
  config.forward.capacity = Capacity::Steps({Mbps(20), Mbps(2)}, std::chrono::seconds(8));
  return config;
}

SimulationConfig LittleBesideCubic() {
  Parameters parameters;
  parameters.ecn = Ecn::kNotEct;
  SimulationConfig config = Named("cubic_fifo_20ms_20M", parameters);
  config.duration = 20s;
  SourceConfig& source = config.flows[0].sources[0];
  source.stream.max_bitrate = Mbps(10);
  source.encoder = [](DataRate) { return EncodedFrame{DataSize::Bytes(5000), {}}; };
  config.others[0].start = 8s;
  return config;
}

SimulationConfig BesideCubic() {
  Parameters parameters;
  parameters.ecn = Ecn::kNotEct;
  SimulationConfig config = Named("cubic_fifo_100ms_20M", parameters);
  config.duration = 20s;
  config.others[0].start = 4s;
  return config;
}

SimulationConfig ClassicMarks() {
  SimulationConfig config = Named("cubic_pi2_20M");
  config.duration = 20s;
  config.others[0].ecn = Ecn::kEct0;
  return config;
}

SimulationConfig Policed() {
  SimulationConfig config = Named("frames_20M_rtt25");
  config.forward.capacity = Capacity::Constant(Mbps(10));
  config.forward.limit.time = 1ms;
  config.forward.aqm.kind = AqmConfig::Kind::kNone;
  return config;
}

SimulationConfig DraftAlone() {
  Parameters parameters = Parameters::Draft();
  parameters.reduce_jitter = parameters.clock_drift = parameters.undershoot_remedy = true;
  SimulationConfig config = Named("frames_8M_rtt40", parameters);
  config.forward.capacity = Capacity::Steps({Mbps(8), Mbps(3), Mbps(12)}, std::chrono::seconds(4));
  config.flows[0].arrival_times = true;
  return config;
}

SimulationConfig WithoutArrivalTimes() {
  SimulationConfig config = Named("slices_20M_rtt25");
  config.flows[0].arrival_times = false;
  return config;
}

SimulationConfig TwoFlows() {
  SimulationConfig config = Named("frames_20M_two_flows");
  config.flows[1].stop_after = 4s;
  return config;
}

SimulationConfig ShortPath() {
  SimulationConfig config = Named("slices_8M_rtt40");
  config.forward.capacity = Capacity::Constant(Mbps(40));
  config.forward.delay = config.return_delay = 1ms;
  config.flows[0].sources = {Slices({1, Mbps(1), Mbps(4), Mbps(25)})};
  return config;
}

/// Returns the figures of a run for each second, and all counters at its end.
std::string Course(const SimulationResult& result) {
  std::ostringstream out;
  Time next = result.config.forward.origin + 1s;
  for (const Sample& sample : result.samples) {
    if (sample.flow == 0 && sample.time >= next)
      next = sample.time + 1s;
    else
      continue;
    const Statistics& s = sample.statistics;
    out << Seconds(sample.time - result.config.forward.origin) << " s:"
        << " target " << s.target_bitrate.bits_per_second() / 1e3 << " window " << s.ref_wnd.bytes()
        << " inflection " << s.ref_wnd_i.bytes() << " pace "
        << s.pace_bitrate.bits_per_second() / 1e3 << " rtt " << Milliseconds(s.s_rtt) << " queue "
        << Milliseconds(s.qdelay_avg) << " alpha " << s.l4s_alpha << " sent " << s.packets_sent
        << " capacity " << s.estimated_capacity.bits_per_second() / 1e3 << " acked "
        << s.acked_bitrate.bits_per_second() / 1e3 << " " << ToString(s.reason) << "\n";
  }
  for (const FlowResult& flow : result.flows) {
    const Statistics& s = flow.statistics;
    out << "end: delivered " << flow.delivered_bytes << " frames " << flow.frames_sent
        << " dropped " << flow.frames_dropped << " reports " << flow.feedback_bytes << " acked "
        << s.packets_acked << " marked " << s.packets_ce << " lost " << s.packets_lost << " late "
        << s.packets_late << " left " << s.packets_dropped << " taken " << s.feedback_accepted
        << " refused " << s.feedback_ignored << " silent " << s.feedback_timeouts << " losses "
        << s.loss_events << " marks " << s.ce_events << " delays " << s.delay_events << " drops "
        << s.capacity_drops << " gaps " << s.gaps << " clocks " << s.clock_resets << " rtt "
        << Milliseconds(s.min_rtt) << " scale " << s.ref_wnd_delay_scale << " loss " << s.loss_rate
        << " target " << Milliseconds(s.qdelay_target) << " ecn " << ToString(s.ecn_state) << " "
        << ToString(s.reason) << "\n";
  }
  return out.str();
}

/// Returns true if two figures are equal or differ by 0.1 % at most. Machines may round the last
/// digit of a figure differently.
bool Same(const std::string& a, const std::string& b) {
  if (a == b) return true;
  char* end_a = nullptr;
  char* end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
  return *end_a == '\0' && *end_b == '\0' && std::abs(x - y) <= 1e-3 * std::abs(y);
}

/// The golden files show how a change of the controller changes whole runs. If the change is
/// intended, run the test with UPDATE_GOLDEN=1 in the environment. The test then writes the files.
class Runs : public ::testing::TestWithParam<Run> {};

TEST_P(Runs, TakeTheCourseThatTheyAlwaysTook) {
  const std::string path = std::string(GOLDEN_FOLDER "/") + GetParam().name + ".txt";
  const std::string course = Course(Simulate(GetParam().config));
  SCOPED_TRACE("Where this is meant: UPDATE_GOLDEN=1 writes " + path);
  if (std::getenv("UPDATE_GOLDEN") != nullptr) std::ofstream(path) << course;
  std::ifstream golden(path);
  std::istringstream now(course);
  std::string before, after;
  while (std::getline(golden, before)) {
    ASSERT_TRUE(std::getline(now, after)) << "no more of: " << before;
    std::istringstream words_before(before), words_after(after);
    std::string a, b;
    while (words_before >> a) {
      ASSERT_TRUE(words_after >> b && Same(b, a)) << "before: " << before << "\nnow:    " << after;
    }
  }
  EXPECT_FALSE(std::getline(now, after)) << after;
}
INSTANTIATE_TEST_SUITE_P(
    All, Runs,
    ::testing::Values(Run{"changing_link", ChangingLink()}, Run{"lossy_fifo", LossyFifo()},
                      Run{"lossy_marking", LossyMarking()}, Run{"outages", Outages()},
                      Run{"seldom_reports", SeldomReports()}, Run{"many_streams", ManyStreams()},
                      Run{"clocks", Clocks()}, Run{"stalls_in_gaps", StallsInGaps()},
                      Run{"another_route", AnotherRoute()}, Run{"little_to_send", LittleToSend()},
                      Run{"little_beside_cubic", LittleBesideCubic()},
                      Run{"beside_cubic", BesideCubic()}, Run{"classic_marks", ClassicMarks()},
                      Run{"policed", Policed()}, Run{"draft_alone", DraftAlone()},
                      Run{"without_arrival_times", WithoutArrivalTimes()},
                      Run{"two_flows", TwoFlows()}, Run{"short_path", ShortPath()}),
    [](const auto& i) { return i.param.name; });

}  // namespace
}  // namespace lidar::scream::test
