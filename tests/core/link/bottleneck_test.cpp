// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/bottleneck.h"

#include <gtest/gtest.h>

#include "src/sim/simulated_time.h"

namespace lidar::link {
namespace {
using namespace std::chrono_literals;

Packet Sized(std::int64_t bytes, std::uint64_t id, Ecn ecn = Ecn::kEct1) {
  return {DataSize::Bytes(bytes), ecn, id};
}

/// Returns a link of 8 Mbit/s, which sends 1000 bytes in a millisecond.
BottleneckConfig Simple() {
  BottleneckConfig c;
  c.origin = kStart;
  c.capacity = Capacity::Constant(Mbps(8));
  return c;
}

/// Calls Deliver() at each time that the link asks for. Returns the outcomes of all packets.
std::vector<Outcome> Drain(Bottleneck* link) {
  std::vector<Outcome> all;
  while (link->NextEventTime() < Time::max())
    for (const Outcome& o : link->Deliver(link->NextEventTime())) all.push_back(o);
  return all;
}

TEST(Bottleneck, APacketTakesItsSerialisationAndThePropagation) {
  auto config = Simple();
  config.delay = 20ms;
  Bottleneck link(config);
  link.Enqueue(kStart + 5ms, Sized(1000, 7));
  EXPECT_EQ(link.NextEventTime(), kStart + 26ms);
  EXPECT_TRUE(link.Deliver(kStart + 26ms - 1ns).empty());
  const auto out = link.Deliver(kStart + 26ms);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out[0].packet.id, 7U);
  EXPECT_EQ(out[0].arrival, kStart + 26ms);
  EXPECT_EQ(out[0].sojourn, 0ms);
  EXPECT_EQ(link.NextEventTime(), Time::max());
}

TEST(Bottleneck, ABurstLeavesInOrderAtTheLinksRate) {
  Bottleneck link(Simple());
  for (std::uint64_t i = 0; i < 5; ++i) link.Enqueue(kStart, Sized(1000, i));
  EXPECT_EQ(link.queued(), DataSize::Bytes(4000)) << "the first is being sent";
  const auto out = Drain(&link);
  ASSERT_EQ(out.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(out[i].packet.id, i);
    EXPECT_EQ(out[i].sojourn, i * 1ms);
    EXPECT_EQ(out[i].arrival, kStart + (i + 1) * 1ms);
  }
}

TEST(Bottleneck, TheResultDoesNotDependOnHowOftenItIsAsked) {
  auto config = Simple();
  config.aqm.kind = AqmConfig::Kind::kRamp;
  config.loss = 0.05;
  Bottleneck often(config);
  Bottleneck seldom(config);
  std::vector<Outcome> a;
  for (int i = 0; i < 2000; ++i) {
    const Time now = kStart + i * 900us;
    for (auto* link : {&often, &seldom}) link->Enqueue(now, Sized(1000, 0));
    for (const Outcome& o : often.Deliver(now)) a.push_back(o);
  }
  for (const Outcome& o : Drain(&often)) a.push_back(o);
  const auto b = Drain(&seldom);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].arrival, b[i].arrival);
    EXPECT_EQ(a[i].packet.ecn, b[i].packet.ecn);
  }
}

TEST(Bottleneck, AQueueLimitInBytesDropsTheTail) {
  auto config = Simple();
  config.limit.bytes = DataSize::Bytes(2500);
  Bottleneck link(config);
  for (std::uint64_t i = 0; i < 5; ++i) link.Enqueue(kStart, Sized(1000, i));
  EXPECT_EQ(link.stats().queue_full, 2U) << "one being sent, two waiting";
  const auto out = Drain(&link);
  ASSERT_EQ(out.size(), 5U);
  EXPECT_EQ(out[0].packet.id, 3U);
  EXPECT_EQ(out[0].fate, Fate::kQueueFull);
}

TEST(Bottleneck, AnEmptyQueueTakesAPacketAboveItsLimit) {
  auto config = Simple();
  config.limit.bytes = DataSize::Bytes(500);
  Bottleneck link(config);
  // The first packet is being sent. The second packet waits in the queue.
  for (std::uint64_t i = 0; i < 3; ++i) link.Enqueue(kStart, Sized(1000, i));
  EXPECT_EQ(link.stats().queue_full, 1U);
  EXPECT_EQ(link.queued(), DataSize::Bytes(1000));
}

TEST(Bottleneck, AQueueLimitInTimeFollowsTheCapacity) {
  auto config = Simple();
  config.capacity = Capacity::Steps({Mbps(8), Mbps(80)}, 1s);
  config.limit.time = 10ms;
  Bottleneck link(config);
  for (int i = 0; i < 100; ++i) link.Enqueue(kStart, Sized(1000, 0));
  EXPECT_EQ(link.stats().queue_full, 89U);
  Drain(&link);
  for (int i = 0; i < 100; ++i) link.Enqueue(kStart + 2s, Sized(1000, 0));
  EXPECT_EQ(link.stats().queue_full, 89U);
}

TEST(Bottleneck, InAGapTheLastLimitOfTheQueueStands) {
  auto config = Simple();
  config.capacity = Capacity::Steps({Mbps(8), Mbps(0)}, 1s);
  config.limit.time = 10ms;
  Bottleneck link(config);
  link.Enqueue(kStart, Sized(1000, 0));
  for (int i = 0; i < 11; ++i) link.Enqueue(kStart + 1500ms, Sized(1000, 1));
  EXPECT_EQ(link.queued().bytes(), 10000);
}

TEST(Bottleneck, APacketThatCameMarkedIsNotCountedAsMarkedHere) {
  auto config = Simple();
  config.aqm.kind = AqmConfig::Kind::kDualPi2;
  Bottleneck link(config);
  for (int i = 0; i < 100; ++i) link.Enqueue(kStart, Sized(1000, 0, Ecn::kCe));
  Drain(&link);
  EXPECT_EQ(link.stats().delivered, 100U);
  EXPECT_EQ(link.stats().marked, 0U);
}

TEST(Bottleneck, InAGapTheQueueKeepsItsPacketsAndTheirSojournGoesOn) {
  auto config = Simple();
  config.capacity = Capacity::Steps({Mbps(0), Mbps(8)}, 1s);
  config.limit.time = 10ms;
  config.aqm.kind = AqmConfig::Kind::kStep;
  Bottleneck link(config);
  link.Enqueue(kStart, Sized(1000, 0));
  const auto out = Drain(&link);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out[0].arrival, kStart + 1001ms);
  EXPECT_EQ(out[0].sojourn, 1s);
  EXPECT_EQ(out[0].packet.ecn, Ecn::kCe);
}

TEST(Bottleneck, ALinkThatIsDownForEverDeliversNothing) {
  auto config = Simple();
  config.capacity = Capacity::Constant(Mbps(0));
  Bottleneck link(config);
  link.Enqueue(kStart, Sized(1000, 0));
  EXPECT_EQ(link.NextEventTime(), Time::max());
  EXPECT_TRUE(link.Deliver(kStart + 24h).empty());
  EXPECT_EQ(link.queued().bytes(), 1000);
}

TEST(Bottleneck, TheStepMarksEct1AboveItsThresholdAndNothingElse) {
  auto config = Simple();
  config.aqm.kind = AqmConfig::Kind::kStep;
  config.aqm.high = 2ms;
  for (const Ecn ecn : {Ecn::kNotEct, Ecn::kEct1, Ecn::kEct0, Ecn::kCe}) {
    Bottleneck link(config);
    for (std::uint64_t i = 0; i < 6; ++i) link.Enqueue(kStart, Sized(1000, i, ecn));
    const auto out = Drain(&link);
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_EQ(out[i].packet.ecn, ecn == Ecn::kEct1 && i > 2 ? Ecn::kCe : ecn) << i;
  }
}

TEST(Bottleneck, TheRampMarksInProportionToTheSojourn) {
  auto config = Simple();
  config.capacity = Capacity::Constant(Mbps(800));
  config.aqm = {AqmConfig::Kind::kRamp, 2ms, 10ms, {}};
  // The queue delay stays at 5 ms, for which the ramp marks 37.5 % of the packets.
  Bottleneck link(config);
  int marked = 0;
  int counted = 0;
  for (int i = 0; i < 501; ++i) link.Enqueue(kStart, Sized(1000, 0));
  for (int i = 0; i < 20000; ++i) {
    const Time now = kStart + (i + 1) * 10us;
    link.Enqueue(now, Sized(1000, 1));
    for (const Outcome& o : link.Deliver(now)) {
      if (o.packet.id == 0) continue;
      ++counted;
      marked += o.packet.ecn == Ecn::kCe;
      EXPECT_NEAR(Milliseconds(o.sojourn), 5, 0.02);
    }
  }
  ASSERT_GT(counted, 19000);
  EXPECT_NEAR(static_cast<double>(marked) / counted, 0.375, 0.015);
  EXPECT_GE(link.stats().marked, static_cast<std::uint64_t>(marked));
}

TEST(Bottleneck, RandomLossHasItsRateAndItsSeed) {
  auto config = Simple();
  config.loss = 0.02;
  auto lost = [&](std::uint64_t seed) {
    config.seed = seed;
    Bottleneck link(config);
    std::vector<std::uint64_t> ids;
    for (std::uint64_t i = 0; i < 20000; ++i) link.Enqueue(kStart + i * 2ms, Sized(1000, i));
    for (const Outcome& o : Drain(&link))
      if (o.fate == Fate::kLost) ids.push_back(o.packet.id);
    return ids;
  };
  const auto first = lost(1);
  EXPECT_NEAR(static_cast<double>(first.size()), 400, 60);
  EXPECT_EQ(first, lost(1));
  EXPECT_NE(first, lost(2));
}

TEST(Bottleneck, CountsEveryPacketOnce) {
  auto config = Simple();
  config.loss = 0.1;
  config.limit.bytes = DataSize::Bytes(3000);
  Bottleneck link(config);
  for (int i = 0; i < 1000; ++i) link.Enqueue(kStart + i * 800us, Sized(1000, 0));
  EXPECT_EQ(Drain(&link).size(), 1000U);
  const auto& s = link.stats();
  EXPECT_EQ(s.sent, 1000U);
  EXPECT_EQ(s.delivered + s.lost + s.queue_full, 1000U);
  EXPECT_GT(s.queue_full, 0U);
  EXPECT_EQ(s.delivered_size, DataSize::Bytes(1000) * static_cast<double>(s.delivered));
}

}  // namespace
}  // namespace lidar::link
