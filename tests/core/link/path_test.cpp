// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/path.h"

#include <gtest/gtest.h>

#include "src/link/bottleneck.h"
#include "src/sim/simulated_time.h"

namespace lidar::link {
namespace {
using namespace std::chrono_literals;

TEST(Path, AnIdealPathChangesNothing) {
  Path path({}, 1);
  EXPECT_EQ(path.Arrival(kStart), kStart);
  EXPECT_FALSE(path.Duplicates());
}

TEST(Path, JitterDelaysWithinItsBoundAndKeepsTheOrder) {
  PathConfig config;
  config.jitter = 8ms;
  Path path(config, 1);
  Time last{};
  double sum_ms = 0;
  for (int i = 0; i < 2000; ++i) {
    const Time sent = kStart + i * 20ms;
    const Time arrival = path.Arrival(sent);
    EXPECT_GE(arrival, last);
    EXPECT_LE(arrival - sent, 8ms);
    sum_ms += Milliseconds(arrival - sent);
    last = arrival;
  }
  EXPECT_NEAR(sum_ms / 2000, 4, 0.2);
}

TEST(Path, JitterKeepsTheOrderOfPacketsThatAreClose) {
  PathConfig config;
  config.jitter = 8ms;
  Path path(config, 1);
  Time last{};
  for (int i = 0; i < 100; ++i) {
    const Time arrival = path.Arrival(kStart + i * 1ms);
    EXPECT_GE(arrival, last);
    last = arrival;
  }
}

TEST(Path, BurstsComeOutTogether) {
  PathConfig config;
  config.burst_interval = 10ms;
  Path path(config, 1);
  EXPECT_EQ(path.Arrival(kStart + 1ms), kStart + 10ms);
  EXPECT_EQ(path.Arrival(kStart + 9ms), kStart + 10ms);
  EXPECT_EQ(path.Arrival(kStart + 10ms), kStart + 10ms);
  EXPECT_EQ(path.Arrival(kStart + 11ms), kStart + 20ms);
}

TEST(Path, AReorderedPacketIsOvertakenAndHoldsUpNoOther) {
  BottleneckConfig config;
  config.origin = kStart;
  config.path.reorder = 0.1;
  config.path.reorder_delay = 5ms;
  Bottleneck link(config);
  for (std::uint64_t i = 0; i < 1000; ++i)
    link.Enqueue(kStart + i * 1ms, {DataSize::Bytes(100), Ecn::kEct1, i});
  int late = 0;
  std::uint64_t newest = 0;
  for (const Outcome& o : link.Deliver(kStart + 10s)) {
    if (o.packet.id < newest) {
      ++late;
      EXPECT_EQ(o.arrival - o.sent, 5ms);
    } else {
      newest = o.packet.id;
    }
  }
  EXPECT_NEAR(late, 100, 25);
}

TEST(Path, ADuplicateFollowsItsOriginalAndCountsApart) {
  BottleneckConfig config;
  config.origin = kStart;
  config.path.duplicate = 0.2;
  Bottleneck link(config);
  for (std::uint64_t i = 0; i < 1000; ++i)
    link.Enqueue(kStart + i * 1ms, {DataSize::Bytes(100), Ecn::kEct1, i});
  const auto out = link.Deliver(kStart + 10s);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i].duplicate) {
      EXPECT_EQ(out[i].packet.id, out[i - 1].packet.id);
    }
  EXPECT_EQ(link.stats().delivered, 1000U);
  EXPECT_EQ(link.stats().duplicated, out.size() - 1000);
  EXPECT_NEAR(static_cast<double>(out.size()), 1200, 40);
}

}  // namespace
}  // namespace lidar::link
