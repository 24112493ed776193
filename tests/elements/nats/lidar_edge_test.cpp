// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-edge: its configuration, what it tells of itself, and robots that come and go.
#include <gio/gio.h>
#include <httplib.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "src/tools/common/child_process.h"
#include "src/tools/edge/edge_config.h"
#include "src/tools/edge/exposition.h"
#include "tests/elements/nats/nats_pipeline.h"

namespace lidar::test {
namespace {

using edge::ParseEdgeConfig;

TEST(EdgeConfig, TakesWhatItSaysAndDefaultsForTheRest) {
  const auto config = ParseEdgeConfig(R"({
    // comments are fine
    "nats": {"url": "tls://a:4222,tls://b:4222", "jetstream": "fleet", "max-age": 60},
    "http-port": 9464,
    "robots": [{"name": "r7", "sensor": "front", "port": 5007, "srtp-key": "env:KEY"},
               {"name": "r8", "port": 5008, "record": "/r8-%05d.mcap", "record-max-files": 3}]})");
  ASSERT_EQ(config.robots.size(), 2U);
  EXPECT_EQ(config.nats.max_age_s, 60U);
  EXPECT_EQ(config.robots[0].srtp_key, "env:KEY");
  EXPECT_EQ(config.robots[1].sensor, "lidar");
  EXPECT_EQ(config.robots[1].record_max_files, 3U);
  EXPECT_EQ(StreamSubject(config.nats, config.robots[0]), "fleet.r7.lidar.front");
  EXPECT_EQ(StatisticsSubject(config.nats, config.robots[1]), "fleet.r8.statistics.lidar");
  EXPECT_TRUE(ParseEdgeConfig(R"({"robots":[{"name":"a","port":1}]})").nats.url.empty());
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
        WrongConfig{R"({"robots":[{"name":"a"}]})", "robots[0].port is missing"},
        WrongConfig{R"({"robots":[{"name":"a.b","port":1}]})",
                    "robots[0].name is no word of letters, digits, - and _"},
        WrongConfig{R"({"robots":[{"name":"a","port":70000}]})",
                    "robots[0].port is no whole number from 1 to 65535"},
        WrongConfig{R"({"robots":[{"name":"a","port":"1"}]})",
                    "robots[0].port is no whole number from 1 to 65535"},
        WrongConfig{R"({"robots":[{"name":"a","port":1,"srtp-kye":"x"}]})",
                    "robots[0].srtp-kye is not known"},
        WrongConfig{R"({"robots":[{"name":"a","port":1,"max-mbps":-1}]})",
                    "robots[0].max-mbps is out of range"},
        WrongConfig{R"({"robots":[{"name":"a","port":1,"record":"a.mcap","record-max-files":2}]})",
                    "robots[0].record has no number such as %05d, which limits for files need"},
        WrongConfig{R"({"robots":[{"name":"a","port":1},{"name":"b","port":1}]})",
                    "port 1 has two robots"},
        WrongConfig{R"({"robots":[{"name":"a","port":1},{"name":"a","port":2}]})",
                    "a has two sensors called lidar"},
        WrongConfig{R"({"nats":{"prefix":"a.>"},"robots":[{"name":"a","port":1}]})",
                    "nats.prefix is no word of letters, digits, - and _"}));

TEST_P(EdgeConfigWrong, IsNamed) {
  try {
    ParseEdgeConfig(GetParam().text);
    FAIL() << GetParam().text;
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), GetParam().message);
  }
}

TEST(EdgeExposition, HasNumbersByTheirNames) {
  const gst::StructurePtr stats(
      gst_structure_new("s", "packets-lost", G_TYPE_UINT64, guint64{7}, "connected", G_TYPE_BOOLEAN,
                        TRUE, "age", G_TYPE_UINT64, G_MAXUINT64, "reason", G_TYPE_STRING, "x",
                        "rate", G_TYPE_DOUBLE, 0.5, nullptr));
  edge::Exposition exposition;
  exposition.Add("natssink", "{robot=\"a\"}", stats.get());
  exposition.Add("lidar_edge_x", "", 1);
  EXPECT_EQ(
      exposition.text(),
      "# TYPE lidar_edge_x untyped\nlidar_edge_x 1\n"
      "# TYPE lidar_natssink_connected untyped\nlidar_natssink_connected{robot=\"a\"} 1\n"
      "# TYPE lidar_natssink_packets_lost untyped\nlidar_natssink_packets_lost{robot=\"a\"} 7\n"
      "# TYPE lidar_natssink_rate untyped\nlidar_natssink_rate{robot=\"a\"} 0.5\n");
  EXPECT_EQ(edge::ToJson(stats.get()).dump(),
            R"({"connected":true,"packets-lost":7,"rate":0.5,"reason":"x"})");
}

/// A UDP port that is free, for the moment.
int FreePort() {
  GSocket* socket =
      g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP, nullptr);
  GSocketAddress* any = g_inet_socket_address_new_from_string("127.0.0.1", 0);
  g_socket_bind(socket, any, FALSE, nullptr);
  GSocketAddress* bound = g_socket_get_local_address(socket, nullptr);
  const int port = g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(bound));
  for (gpointer object :
       {static_cast<gpointer>(bound), static_cast<gpointer>(any), static_cast<gpointer>(socket)})
    g_object_unref(object);
  return port;
}

class LidarEdge : public NatsTest {
 protected:
  void SetUp() override {
    NatsTest::SetUp();
    if (IsSkipped()) return;
    server_.Start();
    for (int& port : ports_) port = FreePort();
    const std::string path = server_.folder() + "/edge.json";
    nlohmann::json config = {
        {"http-port", 0},
        {"interval", 0.2},
        {"nats", {{"url", server_.url()}, {"jetstream", "fleet"}}},
        {"robots",
         {{{"name", "r1"}, {"port", ports_[0]}, {"record", server_.folder() + "/r1-%05d.mcap"}},
          {{"name", "r2"}, {"port", ports_[1]}, {"max-mbps", 0.1}}}}};
    std::ofstream(path) << config.dump();
    program_ = std::make_unique<tools::ChildProcess>(
        tools::ChildProcess::Config{{std::getenv("LIDAR_EDGE"), path}, "", false});
    ASSERT_TRUE(Eventually([this] {
      program_->ReadLines([this](const std::string& line) {
        metrics_port_ = std::atoi(line.c_str() + line.rfind(':') + 1);
      });
      return metrics_port_ > 0;
    }));
  }
  /// None where it is not told.
  std::optional<double> Metric(const std::string& name, const std::string& robot) {
    httplib::Client client("127.0.0.1", metrics_port_);
    const auto answer = client.Get("/metrics");
    if (!answer || answer->status != 200) return std::nullopt;
    const std::string line = "\n" + name + "{robot=\"" + robot + "\",sensor=\"lidar\"} ";
    const auto at = answer->body.find(line);
    if (at == std::string::npos) return std::nullopt;
    return std::atof(answer->body.c_str() + at + line.size());
  }
  std::unique_ptr<NatsPipeline> Robot(int port, const char* address = "127.0.0.1") {
    auto robot = std::make_unique<NatsPipeline>(
        kLive + "! lidarenc" + kSee + "! rtplidarpay ! screamsink name=n host=" + address +
        " port=" + std::to_string(port));
    robot->Play();
    return robot;
  }

  int ports_[2] = {};
  std::unique_ptr<tools::ChildProcess> program_;
  int metrics_port_ = 0;
};

TEST_F(LidarEdge, HandsOnWhatARobotSendsAndTellsOfIt) {
  NatsPipeline consumer("natssrc name=n subject=fleet.r1.lidar.lidar" + At() +
                        "! fakesink name=see sync=false");
  consumer.Play();
  auto robot = Robot(ports_[0]);
  ASSERT_TRUE(consumer.WaitForBuffers(20));
  const auto got = consumer.buffers();
  const auto sent = robot->buffers();
  const auto first =
      std::find_if(sent.begin(), sent.end(), [&](const Kept& kept) { return kept.SameAs(got[0]); });
  EXPECT_NE(first, sent.end()) << "what came is what was sent";
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_edge_receiving", "r1") == 1; }));
  EXPECT_TRUE(Eventually(
      [&] { return Metric("lidar_natssink_messages_acknowledged", "r1").value_or(0) >= 20; }));
  EXPECT_EQ(Metric("lidar_edge_receiving", "r2"), 0);
  // It says goodbye, and comes again.
  robot->SendEos();
  EXPECT_EQ(robot->WaitForEnd(), "");
  robot.reset();
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_edge_sessions", "r1").value_or(0) >= 2; }));
  const std::size_t before = consumer.count();
  robot = Robot(ports_[0]);
  EXPECT_TRUE(consumer.WaitForBuffers(before + 8));
  program_->Signal(SIGTERM);
  EXPECT_EQ(program_->Wait(), 0);
  EXPECT_TRUE(std::filesystem::exists(server_.folder() + "/r1-00000.mcap"));
}

TEST_F(LidarEdge, ShutsOutARobotThatSendsTooMuchAndNoOther) {
  NatsPipeline consumer("natssrc name=n subject=fleet.r1.lidar.lidar" + At() +
                        "! fakesink name=see sync=false");
  consumer.Play();
  const auto good = Robot(ports_[0]);
  const auto flood = Robot(ports_[1]);
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_edge_penalties", "r2").value_or(0) >= 1; }));
  const std::size_t before = consumer.count();
  EXPECT_TRUE(consumer.WaitForBuffers(before + 8));
  EXPECT_EQ(Metric("lidar_edge_penalties", "r1"), 0);
  EXPECT_EQ(Metric("lidar_edge_failures", "r1"), 0);
}

}  // namespace
}  // namespace lidar::test
