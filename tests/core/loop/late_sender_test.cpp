// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/late_sender.h"

#include <gtest/gtest.h>

#include "src/sim/simulated_time.h"

namespace lidar::loop {
namespace {
using namespace std::chrono_literals;

LateSenderReport Send(const std::string& trace, double share) {
  std::string error;
  LateSenderConfig config;
  config.share = share;
  config.min = Mbps(1.4);
  config.max = Mbps(10);
  return SendLate(*link::Capacity::ParseTrace(trace, false, &error), config);
}

TEST(LateSender, UsesItsShareOfASteadyLink) {
  const LateSenderReport r = Send("0 8", 0.8);
  EXPECT_EQ(r.complete, 600U);
  EXPECT_EQ(r.in_time, 600U);
  EXPECT_NEAR(r.utilisation, 0.8, 0.01);
  EXPECT_LT(r.queue_p95_ms, 5);
}

TEST(LateSender, SendsTheLowestRateWithoutAShare) {
  EXPECT_NEAR(Send("0 8", 0).utilisation, 1.4 / 8, 0.01);
}

TEST(LateSender, LosesTheScansOfAGap) {
  const LateSenderReport r = Send("0 8\n10.001 0\n11.001 8", 0.8);
  EXPECT_NEAR(static_cast<double>(r.complete), 591, 1)
      << "a second, less what is newest at its end";
}

/// A sender that fills the link has more data on the way than a sender with a fixed step. These
/// data must be sent first.
TEST(LateSender, LosesMoreTheMoreOfTheLinkItUses) {
  std::string trace = "0 10";
  for (int s = 1; s < 60; ++s) {
    const std::string second = "\n" + std::to_string(s);
    trace += second + ".00 0" + second + ".16 2" + second + ".40 10";
  }
  EXPECT_LT(Send(trace, 0.9).in_time, Send(trace, 0).in_time);
}

TEST(LateSender, QueuesForARoundTripAfterADrop) {
  std::string swings = "0 10";
  for (int s = 1; s < 60; ++s) swings += "\n" + std::to_string(s) + (s % 2 ? " 2" : " 10");
  EXPECT_GT(Send(swings, 0.8).queue_p95_ms, Send("0 10", 0.8).queue_p95_ms);
}

}  // namespace
}  // namespace lidar::loop
