// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the configuration of lidar-edge.
#include "src/tools/apps/edge/edge_config.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lidar::test {
namespace {

using edge::ParseEdgeConfig;

TEST(EdgeConfig, TakesWhatItSaysAndDefaultsForTheRest) {
  const auto config = ParseEdgeConfig(R"({
    // comments are fine
    "nats": {"url": "tls://a:4222,tls://b:4222", "jetstream": "fleet", "replicas": 3,
             "max-age": 60},
    "http-port": 9464,
    "robots": [{"name": "r7", "sensor": "front", "port": 5007, "srtp-key": "env:KEY"},
               {"name": "r8", "port": 5008, "record": "/r8-%05d.mcap", "record-max-files": 3}]})");
  ASSERT_EQ(config.robots.size(), 2U);
  ASSERT_TRUE(config.nats.connection);
  EXPECT_EQ(config.nats.connection->url, "tls://a:4222,tls://b:4222");
  EXPECT_EQ(config.nats.replicas, 3);
  EXPECT_EQ(config.nats.max_age_s, 60U);
  EXPECT_EQ(config.robots[0].srtp_key, "env:KEY");
  EXPECT_EQ(config.robots[1].sensor, "lidar");
  EXPECT_EQ(config.robots[1].record_max_files, 3U);
  EXPECT_EQ(StreamSubject(config.nats, config.robots[0]), "fleet.r7.lidar.front");
  EXPECT_EQ(StatisticsSubject(config.nats, config.robots[1]), "fleet.r8.statistics.lidar");
  EXPECT_FALSE(ParseEdgeConfig(R"({"robots":[{"name":"a","port":1}]})").nats.connection);
}

TEST(EdgeConfig, APortIsFor1000RobotsAtMost) {
  const auto parse = [](int robots) {
    std::string text = R"({"port": 5000, "robots": [)";
    for (int i = 1; i <= robots; ++i)
      text += (i > 1 ? R"(,{"name": "r)" : R"({"name": "r)") + std::to_string(i) +
              R"(", "ssrc": ")" + std::to_string(i) + R"("})";
    return ParseEdgeConfig(text + "]}");
  };
  EXPECT_EQ(parse(1'000).robots.size(), 1'000U);
  EXPECT_THROW(parse(1'001), std::runtime_error);
}

}  // namespace
}  // namespace lidar::test
