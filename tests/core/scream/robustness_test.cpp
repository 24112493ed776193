// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests how soon a running flow recovers from faults of its path.
#include <gtest/gtest.h>

#include "src/sim/scenarios.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

/// A simulated run. The functions return figures of a part of the run, given by times since its
/// start.
class Trial {
 public:
  explicit Trial(const Scenario& s)
      : origin_(s.config.forward.origin), result_(Simulate(s.config)) {}

  double Mbps(Duration from, Duration until) const {
    return static_cast<double>(result_.DeliveredBytes(origin_ + from, origin_ + until)) * 8 /
           Seconds(until - from) / 1e6;
  }
  double Utilisation(Duration from, Duration until) const {
    return result_.Utilisation(origin_ + from, origin_ + until);
  }
  double MaxQueueMs(Duration from, Duration until) const {
    return result_.QueueDelay(origin_ + from, origin_ + until).max;
  }
  /// Returns which share of the packets that were sent between `from` and `until` was lost.
  double OwnLoss(Duration from, Duration until) const {
    double sent = 0, lost = 0;
    for (const PacketLog& p : result_.packets) {
      if (p.sent < origin_ + from || p.sent >= origin_ + until) continue;
      ++sent;
      lost += p.delivered ? 0 : 1;
    }
    return lost / sent;
  }
  /// Returns the statistics at the time `t`.
  Statistics At(Duration t) const {
    for (const Sample& s : result_.samples)
      if (s.time >= origin_ + t) return s.statistics;
    return result_.flows[0].statistics;
  }
  Statistics End() const { return result_.flows[0].statistics; }

 private:
  Time origin_;
  SimulationResult result_;
};

Scenario Named(const char* name) { return *FindScenario(name, Parameters()); }

/// Returns the scenario with an outage from 10 s to 40 s. In this time the path queues 100 kB and
/// drops all further packets.
Scenario WithOutage(Scenario s) {
  s.config.forward.capacity.AddOutage(10s, 40s);
  s.config.forward.limit.bytes = DataSize::Bytes(100000);
  s.config.duration = 50s;
  return s;
}

TEST(Outage, TheTargetFallsToItsMinimumAndTheSenderToItsMinimumRate) {
  for (const Duration rtt : {10ms, 40ms, 200ms}) {
    Scenario s = WithOutage(Named("frames_8M_rtt40"));
    s.config.forward.delay = s.config.return_delay = rtt / 2;
    const Trial run(s);
    EXPECT_NEAR(run.At(20s).target_bitrate.bits_per_second(), 100e3, 1) << Milliseconds(rtt);
    EXPECT_LE(run.At(30s).sent_bitrate.bits_per_second(), 60e3) << Milliseconds(rtt);
    EXPECT_GT(run.At(30s).sent_bitrate.bits_per_second(), 0) << Milliseconds(rtt);
    EXPECT_GT(run.End().feedback_timeouts, 3U);
  }
}

TEST(Outage, IsForgottenASecondAfterThePathReturns) {
  for (const char* name : {"frames_20M_rtt25", "frames_8M_rtt40", "frames10_8M_rtt40",
                           "slices_8M_rtt40", "frames_8M_fifo100_notect"}) {
    const Trial run(WithOutage(Named(name)));
    // At 10 frames/s the rounds are long, so the rate rises more slowly.
    EXPECT_GT(run.Utilisation(41s, 43s), std::string(name) == "frames10_8M_rtt40" ? 0.6 : 0.7)
        << name;
    EXPECT_LT(run.MaxQueueMs(42s, 43s), 60) << name;
  }
}

TEST(Outage, OfTheWayBackAloneIsForgottenAsSoon) {
  Scenario s = Named("frames_8M_rtt40");
  s.config.return_outage_from = 10s;
  s.config.return_outage_until = 20s;
  const Trial run(s);
  EXPECT_NEAR(run.At(19s).target_bitrate.bits_per_second(), 100e3, 1);
  EXPECT_GT(run.Utilisation(21s, 23s), 0.7);
}

/// The link stops as in a handover: it loses no packets, and afterwards its capacity is the same as
/// before.
TEST(Freeze, OfTheLinkIsNoDropOfItsCapacity) {
  for (const char* name :
       {"frames_20M_rtt25", "frames_8M_rtt40", "frames10_8M_rtt40", "slices_8M_rtt40"}) {
    for (const Duration length : {30ms, 100ms}) {
      Scenario s = Named(name);
      for (Duration at = 10s; at < 26s; at += 2013ms)
        s.config.forward.capacity.AddOutage(at, at + length);
      const Trial run(s);
      EXPECT_GT(run.Utilisation(10s, 26s), 0.78) << name << " " << Milliseconds(length);
      const double before = static_cast<double>(run.At(9900ms).ref_wnd.bytes());
      for (Duration t = 10s; t < 26s; t += 10ms)
        ASSERT_GT(static_cast<double>(run.At(t).ref_wnd.bytes()), 0.5 * before)
            << name << " " << Milliseconds(length) << " at " << Milliseconds(t);
    }
  }
}

struct Jump {
  const char* name;
  Duration sender, receiver;
};
class ClockJump : public ::testing::TestWithParam<Jump> {};
TEST_P(ClockJump, IsForgottenWithinASecond) {
  for (const char* name : {"frames_8M_rtt40", "slices_8M_rtt40", "frames_8M_fifo100_notect"}) {
    Scenario s = Named(name);
    const Trial calm(s);
    FlowConfig& flow = s.config.flows[0];
    flow.clock_jump = 15s;
    flow.sender_jump = GetParam().sender;
    flow.receiver_jump = GetParam().receiver;
    const Trial run(s);
    EXPECT_GT(run.Utilisation(15s, 17s), 0.7) << name;
    EXPECT_GT(run.Utilisation(17s, 30s), calm.Utilisation(17s, 30s) - 0.1) << name;
    EXPECT_LT(run.MaxQueueMs(15s, 30s), calm.MaxQueueMs(3s, 30s) + 20) << name;
    EXPECT_LT(Milliseconds(run.End().s_rtt), 100) << name;
    EXPECT_EQ(run.End().packets_lost, calm.End().packets_lost) << name;
  }
}
INSTANTIATE_TEST_SUITE_P(OfAnHour, ClockJump,
                         ::testing::Values(Jump{"SenderAhead", 1h, 0h}, Jump{"SenderBack", -1h, 0h},
                                           Jump{"ReceiverAhead", 0h, 1h},
                                           Jump{"ReceiverBack", 0h, -1h},
                                           Jump{"ReceiverAheadASecond", 0h, 1s},
                                           Jump{"BothAhead", 1h, 1h}),
                         [](const auto& i) { return i.param.name; });

TEST(Restart, OfTheSenderStartsANewFlowAtOnce) {
  Scenario s = Named("frames_8M_rtt40");
  s.config.flows[0].sender_restart = 15s;
  const Trial run(s);
  EXPECT_GT(run.Utilisation(16500ms, 18s), 0.85);
  EXPECT_LT(run.MaxQueueMs(15s, 18s), 30);
  EXPECT_EQ(run.End().feedback_ignored, 0U);
}

TEST(Restart, OfTheReceiverIsForgottenWithinTwoSeconds) {
  Scenario s = Named("frames_20M_rtt25");
  s.config.flows[0].receiver_restart = 10s;
  const Trial run(s);
  EXPECT_GT(run.Utilisation(10s, 12s), 0.8);
  EXPECT_GT(run.Utilisation(12s, 20s), 0.9);
  EXPECT_EQ(run.End().feedback_ignored, 0U);
}

/// A payloader restarts and continues with its SSRC, but with other sequence numbers.
TEST(Restart, OfSequenceNumbersAloneChangesNothing) {
  for (const std::uint16_t back : {std::uint16_t{30500}, std::uint16_t{1000}}) {
    Scenario s = Named("frames_8M_rtt40");
    s.config.flows[0].sequence_jump = 15s;
    s.config.flows[0].jump_back = back;
    const Trial run(s);
    EXPECT_GT(run.Utilisation(15s, 40s), 0.95) << back;
    EXPECT_LT(run.MaxQueueMs(15s, 40s), 12) << back;
    EXPECT_GT(run.At(39s).acked_bitrate.bits_per_second(), 7e6) << back;
    EXPECT_LT(run.End().feedback_ignored, 5U) << back;
  }
}

TEST(LossBurst, DoesNotPinTheRateOnALinkThatBecomesFaster) {
  Scenario s = Named("frames_20M_rtt25");
  s.config.forward.capacity = *link::Capacity::ParseTrace("0 10\n20 80\n", false, nullptr);
  s.config.flows[0].sources[0].stream.max_bitrate = Mbps(100);
  s.config.loss_from = 15s;
  s.config.loss_until = 15100ms;
  const Trial run(s);
  EXPECT_GT(run.Mbps(22s, 25s), 70);
  EXPECT_GT(run.Mbps(25s, 30s), 70);
}

/// With a queue limit of 1 ms, the link drops nearly all packets above its rate, as a policer does.
TEST(Policer, IsUsedWithoutMuchLoss) {
  Scenario s = Named("frames_20M_rtt25");
  s.config.forward.capacity = link::Capacity::Constant(Mbps(10));
  s.config.forward.limit.time = 1ms;
  s.config.forward.aqm.kind = link::AqmConfig::Kind::kNone;
  const Trial run(s);
  EXPECT_GT(run.Utilisation(10s, 40s), 0.7);
  EXPECT_LT(run.OwnLoss(10s, 40s), 0.01);
}

TEST(Feedback, WithoutArrivalTimesStillTellsOfMarksAndRoundTrips) {
  for (const char* name : {"frames_8M_rtt40", "slices_8M_rtt40"}) {
    Scenario s = Named(name);
    s.config.flows[0].arrival_times = false;
    const Trial run(s);
    EXPECT_GT(run.Utilisation(5s, 40s), 0.8) << name;
    EXPECT_LT(run.MaxQueueMs(5s, 40s), 15) << name;
    EXPECT_NEAR(Milliseconds(run.End().s_rtt), 45, 8) << name;
  }
}

/// Returns the scenario with a route that becomes longer at 15 s.
Scenario OnALongerRoute(Scenario s) {
  s.config.flows[0].route_change = 15s;
  s.config.longer_by = 30ms;
  s.config.longer_from = 15s;
  return s;
}

TEST(RouteChange, KeepsTheFlowGoingAndTestsEcnAnew) {
  const Trial run(OnALongerRoute(Named("frames_8M_rtt40")));
  EXPECT_GT(run.Utilisation(16500ms, 18s), 0.75);
  EXPECT_LT(run.MaxQueueMs(15s, 18s), 30);
  EXPECT_EQ(run.End().ecn_state, EcnState::kCapable);
}

/// The marks of the old route's bottleneck show nothing about the bottleneck of the new route.
TEST(RouteChange, LearnsMarksAnew) {
  const Trial run(OnALongerRoute(Named("slices_8M_step1ms")));
  EXPECT_GT(run.Utilisation(16500ms, 21s), 0.85);
  EXPECT_LT(run.MaxQueueMs(15s, 21s), 15);
}

TEST(Feedback, ThatIsSlowCostsLittle) {
  Scenario s = Named("frames_8M_rtt40");
  s.config.return_delay += 150ms;
  const Trial run(s);
  EXPECT_GT(run.Utilisation(10s, 40s), 0.75);
  EXPECT_LT(run.MaxQueueMs(10s, 40s), 30);
}

/// Receivers that use the code of the reference implementation send one report per frame.
TEST(Feedback, OnceAFrameIsEnough) {
  for (const char* name :
       {"frames_20M_rtt25", "frames_8M_rtt40", "frames10_8M_rtt40", "frames_20M_two_flows"}) {
    Scenario s = Named(name);
    const ScenarioMetrics close = Measure(s, Simulate(s.config));
    for (FlowConfig& flow : s.config.flows) {
      flow.feedback.report_on_ce_change = false;
      flow.feedback.packets_per_feedback = 32;
      flow.feedback.feedback_fraction = 0;
    }
    const ScenarioMetrics far = Measure(s, Simulate(s.config));
    EXPECT_GT(far.utilisation, close.utilisation - 0.02) << name;
    EXPECT_LT(far.queue_ms.p50, close.queue_ms.p50 + 1) << name;
    EXPECT_LT(far.queue_ms.p99, 6) << name;
    EXPECT_GT(far.jain, 0.99) << name;
  }
}

TEST(Feedback, ThatIsLostInPartCostsLittleAndAddsNoQueue) {
  for (const char* name : {"frames_8M_rtt40", "slices_8M_rtt40", "frames_8M_fifo100_notect"}) {
    Scenario s = Named(name);
    const Trial clean(s);
    s.config.return_loss = 0.2;
    EXPECT_GT(Trial(s).Utilisation(5s, 40s), clean.Utilisation(5s, 40s) - 0.05) << name;
    s.config.return_loss = 0.5;
    const Trial run(s);
    EXPECT_GT(run.Utilisation(5s, 40s), 0.5) << name;
    EXPECT_LT(run.MaxQueueMs(5s, 40s), 60) << name;
    EXPECT_EQ(run.End().packets_lost, 0U) << name;
  }
}

/// As in a local network, the round trip is short. A window that holds one round trip is less than
/// the data that arrives between two reports.
TEST(ShortPath, IsUsedFromTheStartByAStreamThatNeedsLittle) {
  for (const char* name : {"frames_8M_rtt40", "frames_8M_fifo100_notect"}) {
    for (const Duration rtt : {Duration(200us), Duration(1ms), Duration(3ms)}) {
      Scenario s = Named(name);
      s.config.forward.capacity = link::Capacity::Constant(Mbps(100));
      s.config.forward.delay = s.config.return_delay = rtt / 2;
      s.config.flows[0].sources[0].stream.max_bitrate = Mbps(5);
      s.config.duration = 10s;
      const Trial run(s);
      EXPECT_GT(run.Mbps(0s, 1s), 4.5) << name << " " << Milliseconds(rtt);
      EXPECT_NEAR(run.Mbps(1s, 10s), 5, 0.1) << name << " " << Milliseconds(rtt);
      EXPECT_EQ(run.End().packets_dropped, 0U) << name << " " << Milliseconds(rtt);
    }
  }
}

/// MIN_REF_WND per round trip is a higher rate than the rate of this link.
TEST(MinimumWindow, IsHeldOnALinkThatIsSlowerThanIt) {
  Scenario s = Named("frames_8M_rtt40");
  s.config.forward.capacity = link::Capacity::Constant(Mbps(0.5));
  s.config.forward.delay = s.config.return_delay = 5ms;
  s.config.flows[0].sources[0].stream.start_bitrate = Mbps(0.3);
  const Trial run(s);
  EXPECT_GT(run.Utilisation(5s, 40s), 0.8);
  EXPECT_LT(run.MaxQueueMs(5s, 40s), 100);
  EXPECT_GE(run.End().ref_wnd.bytes(), 3000);
  EXPECT_EQ(run.End().packets_lost, 0U);
}

}  // namespace
}  // namespace lidar::scream::test
