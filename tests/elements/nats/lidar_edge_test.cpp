// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of lidar-edge with robots that connect and disconnect.
#include <gio/gio.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "ext/nats/nats_ptr.h"
#include "src/tools/common/child_process.h"
#include "tests/elements/nats/http_get.h"
#include "tests/elements/nats/nats_client.h"
#include "tests/elements/nats/nats_pipeline.h"
#include "tests/support/free_ports.h"
#include "tests/support/test_certificates.h"

namespace lidar::test {
namespace {

class LidarEdge : public NatsTest {
 protected:
  /// Starts lidar-edge with `config`, a free HTTP port and a short `interval`.
  void StartEdge(nlohmann::json config) {
    config["http-port"] = 0;
    config["interval"] = 0.2;
    const std::string path = server_.folder() + "/edge.json";
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
  std::size_t Recordings(const std::string& robot) const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(server_.folder()))
      if (entry.path().filename().string().rfind(robot + "-", 0) == 0) ++count;
    return count;
  }
  std::unique_ptr<NatsPipeline> Consumer(const std::string& subject, const std::string& more = "") {
    auto consumer = std::make_unique<NatsPipeline>("natssrc name=n subject=" + subject + At(more) +
                                                   "! fakesink name=see sync=false");
    consumer->Play();
    return consumer;
  }
  bool EndsByItself() {
    program_->Signal(SIGTERM);
    return Eventually([this] { return program_->Ended(); }) && program_->Wait() == 0;
  }
  /// Reads the metrics. Tries again if a request takes two seconds, because the program then closes
  /// the connection.
  std::optional<std::string> Metrics() const {
    const std::string host = "127.0.0.1:" + std::to_string(metrics_port_);
    std::optional<std::string> answer;
    Eventually([&] { return (answer = HttpGet(host, "/metrics")).has_value(); });
    return answer;
  }
  /// Returns the value of the metric, or nothing if the metric is missing.
  std::optional<double> Metric(const std::string& name, const std::string& robot) {
    const auto answer = Metrics();
    if (!answer) return std::nullopt;
    const std::string line = "\n" + name + "{robot=\"" + robot + "\",sensor=\"lidar\"} ";
    const auto at = answer->find(line);
    if (at == std::string::npos) return std::nullopt;
    return std::atof(answer->c_str() + at + line.size());
  }
  /// Returns true once the statistics show that the edge forwards new messages of the robot.
  bool GoesOn(const std::string& robot) {
    const auto sent = [&] { return Metric("lidar_natssink_messages", robot).value_or(0); };
    const double before = sent();
    return Eventually([&] { return sent() > before + 16; });
  }
  std::unique_ptr<NatsPipeline> Robot(int port, const std::string& more = "",
                                      const std::string& payloader = "rtplidarpay") {
    auto robot = std::make_unique<NatsPipeline>(
        kLive + "! lidarenc" + kSee + "! " + payloader +
        " ! screamsink name=n host=127.0.0.1 port=" + std::to_string(port) + " " + more);
    robot->Play();
    return robot;
  }

  std::unique_ptr<tools::ChildProcess> program_;
  int metrics_port_ = 0;
};

/// A fixture with a robot that is recorded and a robot whose bitrate is limited to a low value.
class TwoRobots : public LidarEdge {
 protected:
  void SetUp() override {
    LidarEdge::SetUp();
    if (IsSkipped()) return;
    server_.Start();
    ports_ = FreePorts(2);
    StartEdge(
        {{"nats", {{"url", server_.url()}, {"jetstream", "fleet"}}},
         {"robots",
          {{{"name", "r1"}, {"port", ports_[0]}, {"record", server_.folder() + "/r1-%05d.mcap"}},
           {{"name", "r2"}, {"port", ports_[1]}, {"max-mbps", 0.1}}}}});
  }

  std::vector<int> ports_;
};

TEST_F(TwoRobots, HandsOnWhatARobotSendsAndTellsOfIt) {
  const auto consumer = Consumer("fleet.r1.lidar.lidar");
  auto robot = Robot(ports_[0]);
  ASSERT_TRUE(consumer->WaitForBuffers(20));
  const auto got = consumer->buffers();
  const auto sent = robot->buffers();
  const auto first =
      std::find_if(sent.begin(), sent.end(), [&](const Kept& kept) { return kept.SameAs(got[0]); });
  EXPECT_NE(first, sent.end()) << "what came is what was sent";
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_edge_receiving", "r1") == 1; }));
  EXPECT_TRUE(Eventually(
      [&] { return Metric("lidar_natssink_messages_acknowledged", "r1").value_or(0) >= 20; }));
  EXPECT_EQ(Metric("lidar_edge_receiving", "r2"), 0);
  // The robot sends a goodbye, stops, and connects again.
  robot->SendEos();
  EXPECT_EQ(robot->WaitForEnd(), "");
  robot.reset();
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_edge_sessions", "r1").value_or(0) >= 2; }));
  const std::size_t before = consumer->count();
  robot = Robot(ports_[0]);
  EXPECT_TRUE(consumer->WaitForBuffers(before + 8));
  EXPECT_TRUE(EndsByItself());
  EXPECT_EQ(Recordings("r1"), 2U);
}

TEST_F(TwoRobots, OneThatSendsTooMuchIsShutOutAndNoOther) {
  const auto consumer = Consumer("fleet.r1.lidar.lidar");
  const auto good = Robot(ports_[0]);
  const auto flood = Robot(ports_[1]);
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_edge_penalties", "r2").value_or(0) >= 1; }));
  const std::size_t before = consumer->count();
  EXPECT_TRUE(consumer->WaitForBuffers(before + 8));
  EXPECT_EQ(Metric("lidar_edge_penalties", "r1"), 0);
  EXPECT_EQ(Metric("lidar_edge_failures", "r1"), 0);
}

/// Accepts connections, but sends nothing.
class SilentServer {
 public:
  SilentServer()
      : socket_(g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_STREAM, G_SOCKET_PROTOCOL_TCP,
                             nullptr)) {
    GSocketAddress* any = g_inet_socket_address_new_from_string("127.0.0.1", 0);
    g_socket_bind(socket_, any, FALSE, nullptr);
    g_object_unref(any);
    g_socket_set_listen_backlog(socket_, 1'000);
    g_socket_listen(socket_, nullptr);
    GSocketAddress* bound = g_socket_get_local_address(socket_, nullptr);
    port_ = g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(bound));
    g_object_unref(bound);
  }
  ~SilentServer() { g_object_unref(socket_); }
  std::string url() const { return "nats://127.0.0.1:" + std::to_string(port_); }

 private:
  GSocket* socket_;
  int port_ = 0;
};

TEST_F(LidarEdge, AServerThatSaysNothingDelaysNoRobotAndNotTheEnd) {
  const SilentServer silent;
  nlohmann::json robots = nlohmann::json::array();
  for (const int port : FreePorts(60))
    robots.push_back({{"name", "r" + std::to_string(robots.size())}, {"port", port}});
  // The test would be too slow if robots waited for the server one after the other: the start and
  // the end would each take a minute.
  robots.back()["record"] = server_.folder() + "/last-%05d.mcap";
  StartEdge({{"nats", {{"url", silent.url()}}}, {"robots", robots}});
  const auto robot = Robot(robots.back()["port"]);
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_edge_receiving", "r59") == 1; }));
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_mcapsink_messages", "r59").value_or(0) > 0; }));
  EXPECT_TRUE(EndsByItself());
  EXPECT_EQ(Recordings("last"), 1U);
}

TEST_F(LidarEdge, AServerThatRefusesDoesNotEndARecordingAndMayTakeUsLater) {
  server_.Start({"--user", "edge", "--pass", "first"});
  const int port = FreePort();
  StartEdge({{"nats", {{"url", server_.url("nats", "edge:second@")}}},
             {"robots",
              {{{"name", "r1"}, {"port", port}, {"record", server_.folder() + "/r1-%05d.mcap"}}}}});
  const auto robot = Robot(port);
  ASSERT_TRUE(Eventually([&] { return Metric("lidar_edge_receiving", "r1") == 1; }));
  ASSERT_TRUE(Eventually([&] { return Metric("lidar_natssink_refusals", "r1").value_or(0) >= 2; }));
  server_.Start({"--user", "edge", "--pass", "second"});
  const NatsClient client(server_.url("nats", "edge:second@"));
  const auto statistics = client.Subscribe("fleet.r1.statistics.lidar");
  NatsPipeline consumer("natssrc name=n subject=fleet.r1.lidar.lidar url=" +
                        server_.url("nats", "edge:second@") + " ! fakesink name=see sync=false");
  consumer.Play();
  EXPECT_TRUE(consumer.WaitForBuffers(8));
  natsMsg* report = nullptr;
  EXPECT_EQ(natsSubscription_NextMsg(&report, statistics.get(), NatsClient::kPatienceMs), NATS_OK);
  natsMsg_Destroy(report);
  EXPECT_EQ(Metric("lidar_edge_sessions", "r1"), 1);
  EXPECT_EQ(Metric("lidar_edge_failures", "r1"), 0);
  EXPECT_TRUE(EndsByItself());
  EXPECT_EQ(Recordings("r1"), 1U);
}

TEST_F(LidarEdge, ARecordingThatFailsDoesNotEndTheStream) {
  server_.Start();
  const int port = FreePort();
  const std::string folder = server_.folder() + "/later";
  StartEdge({{"nats", {{"url", server_.url()}}},
             {"robots", {{{"name", "r1"}, {"port", port}, {"record", folder + "/%05d.mcap"}}}}});
  const auto consumer = Consumer("fleet.r1.lidar.lidar");
  const auto robot = Robot(port);
  ASSERT_TRUE(
      Eventually([&] { return Metric("lidar_edge_record_failures", "r1").value_or(0) >= 1; }));
  EXPECT_TRUE(consumer->WaitForBuffers(8));
  std::filesystem::create_directory(folder);
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_mcapsink_messages", "r1").value_or(0) > 0; }));
  EXPECT_EQ(Metric("lidar_edge_sessions", "r1"), 1);
  EXPECT_EQ(Metric("lidar_edge_failures", "r1"), 0);
  EXPECT_EQ(consumer->stat("messages-lost"), 0U);
}

TEST_F(LidarEdge, ADiskThatHangsDelaysNoOtherRobotAndNotTheEnd) {
  server_.Start();
  const auto ports = FreePorts(2);
  // Opening a FIFO for writing blocks until there is a reader. mcapsink opens an existing file only
  // if its location has no number; `%%` stands for a single %.
  ASSERT_EQ(mkfifo((server_.folder() + "/stuck%.mcap").c_str(), 0600), 0);
  const std::string stuck = server_.folder() + "/stuck%%.mcap";
  StartEdge(
      {{"nats", {{"url", server_.url()}}},
       {"robots",
        {{{"name", "r1"}, {"port", ports[0]}, {"record", stuck}},
         {{"name", "r2"}, {"port", ports[1]}, {"record", server_.folder() + "/r2-%05d.mcap"}}}}});
  const auto first = Consumer("fleet.r1.lidar.lidar");
  const auto second = Consumer("fleet.r2.lidar.lidar");
  const auto r1 = Robot(ports[0]);
  const auto r2 = Robot(ports[1]);
  EXPECT_TRUE(first->WaitForBuffers(8));
  EXPECT_TRUE(second->WaitForBuffers(8));
  // The file of r2 is opened when its first chunk is written, after about a second.
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_mcapsink_chunks", "r2").value_or(0) > 0; }));
  const auto recorded = [&] { return Metric("lidar_mcapsink_messages", "r1"); };
  EXPECT_TRUE(Eventually([&] {
    const auto before = recorded();
    return GoesOn("r1") && before.value_or(0) > 0 && recorded() == before;
  })) << "the recorder hangs, and its robot's statistics do not";
  EXPECT_TRUE(GoesOn("r2"));
  EXPECT_TRUE(EndsByItself());
  EXPECT_EQ(Recordings("r2"), 1U);
}

TEST_F(LidarEdge, TakesEncryptedRobotsToAServerThatWantsCredentials) {
  const auto options = server_.OptionsForCredentials();
  if (options.empty()) GTEST_SKIP() << "openssl or python3 is not installed";
  server_.Start(options);
  const auto ports = FreePorts(2);
  const std::string key = server_.folder() + "/key";
  std::ofstream(key) << std::string(60, 'a');
  std::filesystem::permissions(key, std::filesystem::perms::owner_read);
  StartEdge(
      {{"nats", {{"url", server_.url()}, {"credentials-file", server_.folder() + "/good.creds"}}},
       {"robots",
        {{{"name", "r1"}, {"port", ports[0]}, {"srtp-key", "file:" + key}},
         {{"name", "r2"}, {"port", ports[1]}, {"srtp-key", "file:" + key}}}}});
  const auto consumer =
      Consumer("fleet.r1.lidar.lidar", "credentials-file=" + server_.folder() + "/good.creds");
  const auto robot = Robot(ports[0], "srtp-key=file:" + key);
  const auto forger = Robot(ports[1]);
  EXPECT_TRUE(consumer->WaitForBuffers(8));
  EXPECT_TRUE(
      Eventually([&] { return Metric("lidar_screamsrc_srtp_refused", "r2").value_or(0) > 0; }));
  EXPECT_EQ(Metric("lidar_edge_receiving", "r2"), 0);
}

/// Expects that `got` has each slice of `sent` exactly once, in any order.
void ExpectSameSlices(std::vector<Kept> got, std::vector<Kept> sent) {
  ASSERT_EQ(got.size(), sent.size());
  const auto earlier = [](const Kept& a, const Kept& b) {
    return std::pair(a.slice.scan_id, a.slice.slice_index) <
           std::pair(b.slice.scan_id, b.slice.slice_index);
  };
  std::sort(got.begin(), got.end(), earlier);
  std::sort(sent.begin(), sent.end(), earlier);
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_TRUE(got[i].SameAs(sent[i])) << i;
}

/// Returns true if the consumer received at least one buffer that the robot sent.
bool Has(const NatsPipeline& consumer, const NatsPipeline& robot) {
  const auto sent = robot.buffers();
  const auto got = consumer.buffers();
  return std::any_of(got.begin(), got.end(), [&](const Kept& g) {
    return std::any_of(sent.begin(), sent.end(), [&](const Kept& s) { return s.SameAs(g); });
  });
}

TEST_F(LidarEdge, RobotsOnOnePortAreToldApartBySsrcAndKey) {
  server_.Start();
  const int port = FreePort();
  const std::string keys[] = {std::string(60, 'a'), std::string(60, 'b')};
  for (const int i : {0, 1}) {
    g_setenv(("EDGE_KEY_" + std::to_string(i)).c_str(), keys[i].c_str(), TRUE);
  }
  StartEdge({{"nats", {{"url", server_.url()}}},
             {"port", port},
             {"robots",
              {{{"name", "r1"}, {"ssrc", "0x100000-0x1fffff"}, {"srtp-key", "env:EDGE_KEY_0"}},
               {{"name", "r2"}, {"ssrc", "7"}, {"srtp-key", "env:EDGE_KEY_1"}},
               {{"name", "r3"}, {"ssrc", "8"}, {"max-mbps", 0.1}}}}});
  const auto first = Consumer("fleet.r1.lidar.lidar");
  const auto second = Consumer("fleet.r2.lidar.lidar");
  auto r1 = Robot(port, "srtp-key=" + keys[0], "rtplidarpay ssrc=1192960");  // SSRC 0x123400
  // The forger uses the SSRC of r2, but the key of r1.
  auto forger = Robot(port, "srtp-key=" + keys[0], "rtplidarpay ssrc=7");
  const auto flood = Robot(port, "", "rtplidarpay ssrc=8");
  const auto stray = Robot(port, "", "rtplidarpay ssrc=99");
  ASSERT_TRUE(first->WaitForBuffers(8));
  EXPECT_TRUE(
      Eventually([&] { return Metric("lidar_screamsrc_srtp_refused", "r2").value_or(0) > 0; }));
  EXPECT_EQ(second->count(), 0U);
  forger.reset();
  const auto r2 = Robot(port, "srtp-key=" + keys[1], "rtplidarpay ssrc=7");
  ASSERT_TRUE(second->WaitForBuffers(8));
  EXPECT_TRUE(Has(*first, *r1));
  EXPECT_TRUE(Has(*second, *r2));
  EXPECT_FALSE(Has(*first, *r2));
  EXPECT_FALSE(Has(*second, *r1));
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_edge_penalties", "r3").value_or(0) >= 1; }));
  // r1 disconnects and comes back with another SSRC that is in its range. This does not disturb the
  // other robots.
  r1->SendEos();
  EXPECT_EQ(r1->WaitForEnd(), "");
  EXPECT_TRUE(Eventually([&] { return Metric("lidar_edge_sessions", "r1").value_or(0) >= 2; }));
  const std::size_t before = first->count();
  r1 = Robot(port, "srtp-key=" + keys[0], "rtplidarpay ssrc=1048577");
  EXPECT_TRUE(first->WaitForBuffers(before + 8));
  EXPECT_EQ(Metric("lidar_edge_sessions", "r2"), 1);
  EXPECT_EQ(Metric("lidar_edge_failures", "r2"), 0);
  EXPECT_TRUE(Eventually([&] { return r1->stat("feedback-accepted") > 0; }))
      << "reports come back from the port";
  EXPECT_TRUE(Eventually([&] {
    const std::string answer = Metrics().value_or("");
    const auto at = answer.find("\nlidar_edge_stray_datagrams ");
    return at != answer.npos && std::atof(answer.c_str() + at + 28) > 0;
  }));
}

TEST_F(LidarEdge, ARobotOfTwoAddressesOnTheSharedPortIsOneRobot) {
  server_.Start();
  const int port = FreePort();
  StartEdge({{"nats", {{"url", server_.url()}}},
             {"port", port},
             {"robots",
              {{{"name", "r1"}, {"ssrc", "7"}, {"record", server_.folder() + "/r1-%05d.mcap"}},
               {{"name", "r2"}, {"ssrc", "8"}, {"record", server_.folder() + "/r2-%05d.mcap"}}}}});
  const auto consumer = Consumer("fleet.r1.lidar.lidar");
  const std::string to = "127.0.0.1:" + std::to_string(port);
  // The recording has the first message only if the session began before it.
  ASSERT_TRUE(Eventually([&] { return Metric("lidar_mcapsink_messages", "r1").has_value(); }));
  const auto robot = Robot(
      port,
      "max-queue-delay=60000000000 bonding-addresses=\"" + to + "@127.0.0.1," + to + "@127.0.0.2\"",
      "rtplidarpay ssrc=7");
  const auto metric = [&](const char* name) { return Metric(name, "r1").value_or(0); };
  // Copies are counted only after the second address has been accepted as a link of the robot.
  ASSERT_TRUE(Eventually([&] { return metric("lidar_screamsrc_packets_copies") > 0; }));
  const double foreign = metric("lidar_screamsrc_packets_foreign");
  ASSERT_TRUE(consumer->WaitForBuffers(40));
  ASSERT_TRUE(GoesOn("r1"));
  EXPECT_EQ(metric("lidar_screamsrc_packets_foreign"), foreign);
  EXPECT_EQ(metric("lidar_edge_sessions"), 1);
  EXPECT_EQ(metric("lidar_edge_failures"), 0);
  EXPECT_EQ(metric("lidar_edge_penalties"), 0);
  EXPECT_EQ(Metric("lidar_edge_receiving", "r2"), 0);
  EXPECT_NE(Metrics().value_or("").find("\nlidar_edge_stray_datagrams 0\n"), std::string::npos);
  robot->SendEos();
  EXPECT_EQ(robot->WaitForEnd(), "");
  EXPECT_TRUE(Eventually([&] { return metric("lidar_edge_sessions") >= 2; }));
  EXPECT_TRUE(EndsByItself());
  EXPECT_EQ(Recordings("r1"), 1U) << "the goodbye of one address is that of both";
  EXPECT_EQ(Recordings("r2"), 0U);
  ExpectSameSlices(
      Play("mcapsrc location=" + server_.folder() + "/r1-00000.mcap ! fakesink name=see")
          .buffers["see"],
      robot->buffers());
}

TEST_F(LidarEdge, ARobotWithACertificateAgreesOnAKeyOverTwoLinks) {
  server_.Start();
  const TestCertificates papers({"robot", "edge", "stranger"});
  const int port = FreePort();
  StartEdge({{"nats", {{"url", server_.url()}}},
             {"robots",
              {{{"name", "r1"},
                {"port", port},
                {"dtls-certificate", papers.WithKey("edge")},
                {"dtls-peer-certificate", papers.Public("robot")}}}}});
  const auto consumer = Consumer("fleet.r1.lidar.lidar");
  const auto metric = [&](const char* name) { return Metric(name, "r1").value_or(0); };
  auto robot = Robot(port, papers.Trusting("stranger", "edge"));
  EXPECT_TRUE(Eventually([&] { return metric("lidar_screamsrc_dtls_refused") > 0; }));
  robot.reset();
  EXPECT_EQ(consumer->count(), 0U);
  const std::string to = "127.0.0.1:" + std::to_string(port);
  const auto come = [&] {
    robot = Robot(port, "bonding-addresses=\"" + to + "@127.0.0.1," + to + "@127.0.0.2\"" +
                            papers.Trusting("robot", "edge"));
  };
  come();
  ASSERT_TRUE(consumer->WaitForBuffers(8));
  EXPECT_TRUE(Has(*consumer, *robot));
  EXPECT_TRUE(Eventually([&] { return metric("lidar_screamsrc_packets_copies") > 0; }));
  EXPECT_EQ(metric("lidar_screamsrc_dtls_handshakes"), 1);
  // The robot sends a goodbye, stops, and connects again.
  robot->SendEos();
  EXPECT_EQ(robot->WaitForEnd(), "");
  EXPECT_TRUE(Eventually([&] { return metric("lidar_edge_sessions") >= 2; }));
  const std::size_t before = consumer->count();
  come();
  EXPECT_TRUE(consumer->WaitForBuffers(before + 8));
  EXPECT_EQ(metric("lidar_edge_failures"), 0);
}

}  // namespace
}  // namespace lidar::test
