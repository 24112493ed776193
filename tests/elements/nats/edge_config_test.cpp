// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-edge: its configuration.
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

TEST(EdgeConfig, TheStreamMayBeAsSmallAsWhatAllRobotsMaySend) {
  const auto config = ParseEdgeConfig(
      R"({"nats":{"url":"a","jetstream":"b","max-bytes":150000000,"max-age":60},
          "robots":[{"name":"a","port":1,"max-mbps":12},{"name":"b","port":2,"max-mbps":8}]})");
  EXPECT_EQ(config.nats.max_bytes, 150'000'000U);
}

struct WrongConfig {
  const char* text;
  const char* message;
};
class EdgeConfigWrong : public ::testing::TestWithParam<WrongConfig> {};
INSTANTIATE_TEST_SUITE_P(
    All, EdgeConfigWrong,
    ::testing::Values(
        WrongConfig{"{", "the configuration is no JSON"},
        WrongConfig{"[]", "the configuration is no object"},
        WrongConfig{"{}", "robots is no list of at least one robot"},
        WrongConfig{R"({"robot":[]})", "robot is not known"},
        WrongConfig{R"({"robots":[7]})", "robots[0] is no object"},
        WrongConfig{R"({"robots":[{"name":"a"}]})", "robots[0].port is missing, and so is ssrc"},
        WrongConfig{R"({"port":5,"robots":[{"name":"a","ssrc":"9-8"}]})",
                    "robots[0].ssrc is no number, and no two with - between"},
        WrongConfig{R"({"port":5,"robots":[{"name":"a","ssrc":"0x1ffffffff"}]})",
                    "robots[0].ssrc is no number, and no two with - between"},
        WrongConfig{R"({"port":5,"robots":[{"name":"a","port":6,"ssrc":"7"}]})",
                    "robots[0].ssrc is of no use on a port of its own"},
        WrongConfig{R"({"robots":[{"name":"a","ssrc":"7"}]})",
                    "port is missing, which robots with an ssrc need"},
        WrongConfig{R"({"port":5,"robots":[{"name":"a","port":6}]})", "port is used by no robot"},
        WrongConfig{R"({"port":5,"robots":[{"name":"a","port":5},{"name":"b","ssrc":"7"}]})",
                    "port 5 is for all robots, and for one"},
        WrongConfig{R"({"port":5,"robots":[{"name":"a","ssrc":"7-9"},{"name":"b","ssrc":"0x9"}]})",
                    "a and b share an ssrc"},
        WrongConfig{R"({"robots":[{"name":"a.b","port":1}]})",
                    "robots[0].name is no word of letters, digits, - and _"},
        WrongConfig{R"({"robots":[{"name":"a","port":70000}]})",
                    "robots[0].port is no whole number from 1 to 65535"},
        WrongConfig{R"({"robots":[{"name":"a","port":"1"}]})",
                    "robots[0].port is no whole number from 1 to 65535"},
        WrongConfig{R"({"robots":[{"name":"a","port":1,"srtp-kye":"x"}]})",
                    "robots[0].srtp-kye is not known"},
        WrongConfig{R"({"robots":[{"name":"a","port":1,"dtls-certificate":"x"}]})",
                    "robots[0].dtls-certificate and dtls-peer-certificate need each other"},
        WrongConfig{R"({"robots":[{"name":"a","port":1,"srtp-key":"x","dtls-certificate":"x",
                                   "dtls-peer-certificate":"x"}]})",
                    "robots[0].srtp-key is of no use beside dtls-certificate"},
        WrongConfig{R"({"port":5,"robots":[{"name":"a","ssrc":"7","dtls-certificate":"x",
                                            "dtls-peer-certificate":"x"}]})",
                    "robots[0].dtls-certificate needs a port of its own: DTLS names no ssrc"},
        WrongConfig{R"({"robots":[{"name":"a","port":1,"max-mbps":-1}]})",
                    "robots[0].max-mbps is out of range"},
        WrongConfig{R"({"robots":[{"name":"a","port":1,"record":"a.mcap","record-max-files":2}]})",
                    "robots[0].record has no number such as %05d, which limits for files need"},
        WrongConfig{
            R"({"robots":[{"name":"a","port":1,"record":"a.mcap","record-max-file-size":9000}]})",
            "robots[0].record has no number such as %05d, which limits for files need"},
        WrongConfig{R"({"robots":[{"name":"a","port":1},{"name":"b","port":1}]})",
                    "port 1 has two robots"},
        WrongConfig{R"({"robots":[{"name":"a","port":1,"record":"x.mcap"},
                                  {"name":"b","port":2,"record":"x.mcap"}]})",
                    "x.mcap is recorded by two robots"},
        WrongConfig{R"({"nats":{"url":"a","jetstream":"b","max-bytes":150000000,"max-age":0},
                        "robots":[{"name":"a","port":1,"max-mbps":12}]})",
                    "nats.max-bytes needs max-age: what is kept for good fills any room"},
        WrongConfig{R"({"robots":[{"name":"a","port":1},{"name":"a","port":2}]})",
                    "a has two sensors called lidar"},
        WrongConfig{R"({"nats":{"url":"a","jetstream":"b","max-bytes":1000},
                        "robots":[{"name":"a","port":1}]})",
                    "nats.max-bytes is for all robots, so a needs max-mbps"},
        WrongConfig{R"({"nats":{"url":"a","jetstream":"b","max-bytes":149999999,"max-age":60},
                        "robots":[{"name":"a","port":1,"max-mbps":12},
                                  {"name":"b","port":2,"max-mbps":8}]})",
                    "nats.max-bytes holds less than what all robots may send in max-age: "
                    "150000000 bytes"},
        WrongConfig{R"({"nats":{"replicas":6},"robots":[{"name":"a","port":1}]})",
                    "nats.replicas is no whole number from 1 to 5"},
        WrongConfig{R"({"nats":{"prefix":"a.>"},"robots":[{"name":"a","port":1}]})",
                    "nats.prefix is no word of letters, digits, - and _"}));

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

TEST(EdgeConfig, NamesHave64LettersAtMost) {
  const auto with = [](std::size_t letters) {
    return ParseEdgeConfig(R"({"robots":[{"port":1,"name":")" + std::string(letters, 'a') +
                           R"("}]})");
  };
  EXPECT_EQ(with(64).robots.size(), 1U);
  EXPECT_THROW(with(65), std::runtime_error);
}

TEST_P(EdgeConfigWrong, IsNamed) {
  try {
    ParseEdgeConfig(GetParam().text);
    FAIL() << GetParam().text;
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), GetParam().message);
  }
}

}  // namespace
}  // namespace lidar::test
