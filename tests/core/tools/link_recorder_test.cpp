// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the figures that lidar-link prints during a run and at its end.
#include "src/tools/bench/lidar_link/recorder.h"

#include <gtest/gtest.h>

namespace lidar::tools {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time kBegin{seconds(5)};

/// A recorder for a link of 8 Mbit/s.
class LinkRecorder : public ::testing::Test {
 protected:
  void SetUp() override { recorder_.Start(kBegin, seconds(1'000)); }
  link::Bottleneck Link() const {
    link::BottleneckConfig config;
    config.origin = kBegin;
    config.capacity = capacity_;
    return link::Bottleneck(config);
  }
  struct Packet {
    std::size_t flow = 0;
    std::int64_t size = 0;
    int sojourn_ms = 0;
    link::Fate fate = link::Fate::kDelivered;
    bool marked = false;
    bool duplicate = false;
    Ecn ecn_in = Ecn::kEct1;
  };
  void Push(const Packet& p) {
    link::Outcome o;
    o.packet = {DataSize::Bytes(p.size), p.marked ? Ecn::kCe : Ecn::kEct1, 0};
    o.fate = p.fate;
    o.sent = o.arrival = kBegin;
    o.sojourn = milliseconds(p.sojourn_ms);
    o.duplicate = p.duplicate;
    recorder_.OnPacket({o, p.ecn_in, p.flow, {}});
  }
  nlohmann::ordered_json LiveAt(int s) {
    return recorder_.Live(kBegin + seconds(s), Link(), capacity_);
  }

  const link::Capacity capacity_ = link::Capacity::Constant(DataRate::BitsPerSecond(8e6));
  Recorder recorder_{""};
};

TEST_F(LinkRecorder, EachLineHasWhatCameSinceTheOneBefore) {
  Push({0, 1'000, 10});
  Push({1, 500, 30, link::Fate::kDelivered, true});
  Push({1, 500, 30, link::Fate::kDelivered, true, true});
  Push({0, 1'000, 40, link::Fate::kQueueFull});
  const auto first = LiveAt(1);
  EXPECT_EQ(first["time_s"], 1.0);
  EXPECT_EQ(first["origin_unix_ns"], 1'005'000'000'000);
  EXPECT_EQ(first["capacity_bps"], 8e6);
  EXPECT_EQ(first["delivered_bps"], 12'000.0);
  EXPECT_EQ(first["packets"], 2);
  EXPECT_EQ(first["marked"], 1);
  EXPECT_EQ(first["dropped"], 1);
  EXPECT_EQ(first["queue_bytes"], 0);
  EXPECT_EQ(first["sojourn_ms"]["p50"], 10.0);
  EXPECT_EQ(first["sojourn_ms"]["max"], 30.0);
  Push({0, 250, 4});
  const auto second = LiveAt(3);
  EXPECT_EQ(second["time_s"], 3.0);
  EXPECT_EQ(second["capacity_bps"], 8e6);
  EXPECT_EQ(second["delivered_bps"], 1'000.0);
  EXPECT_EQ(second["packets"], 1);
  EXPECT_EQ(second["marked"], 0);
  EXPECT_EQ(second["dropped"], 0);
  EXPECT_EQ(second["sojourn_ms"]["max"], 4.0);
}

TEST_F(LinkRecorder, APacketThatCameMarkedIsNotCountedAsMarkedHere) {
  Packet packet;
  packet.marked = true;
  packet.ecn_in = Ecn::kCe;
  Push(packet);
  const auto live = LiveAt(1);
  EXPECT_EQ(live["packets"], 1);
  EXPECT_EQ(live["marked"], 0);
}

TEST_F(LinkRecorder, TheSummaryHasAllOfEachFlow) {
  Push({0, 1'000, 10});
  Push({0, 1'000, 40, link::Fate::kQueueFull});
  LiveAt(1);
  Push({1, 500, 30, link::Fate::kDelivered, true});
  recorder_.OnFeedback(true, 60);
  recorder_.OnFeedback(false, 70);
  recorder_.OnLateness(milliseconds(2));
  const link::Bottleneck link = Link();
  const auto summary = recorder_.Summary(kBegin + seconds(2), &link, capacity_);
  EXPECT_EQ(summary["sojourn_ms"]["p50"], 10.0);
  EXPECT_EQ(summary["sojourn_ms"]["max"], 30.0);
  EXPECT_EQ(summary["lateness_ms"]["max"], 2.0);
  EXPECT_EQ(summary["mean_capacity_bps"], 8e6);
  const auto flow = [](int delivered, int bytes, int dropped, int marked, double bps) {
    return nlohmann::ordered_json{{"delivered", delivered},
                                  {"bytes", bytes},
                                  {"dropped", dropped},
                                  {"marked", marked},
                                  {"mean_rate_bps", bps}};
  };
  EXPECT_EQ(summary["flows"][0], flow(1, 1'000, 1, 0, 4'000));
  EXPECT_EQ(summary["flows"][1], flow(1, 500, 0, 1, 2'000));
  EXPECT_EQ(summary["feedback"],
            (nlohmann::ordered_json{{"packets", 1}, {"bytes", 60}, {"lost", 1}}));
}

}  // namespace
}  // namespace lidar::tools
