// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of lidar-edge: the pauses between the sessions of a robot, and the sessions' reports. The
// test sets the time.
#include <gio/gio.h>

#include <nlohmann/json.hpp>

#include "src/tools/apps/edge/session.h"
#include "src/tools/apps/edge/shared_port.h"
#include "tests/support/free_ports.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Object = std::unique_ptr<void, decltype(&g_object_unref)>;

/// A session without NATS, and a socket that sends packets with an RTP header, as the robot would.
class EdgeSession : public ::testing::Test {
 protected:
  EdgeSession()
      : sender_(g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP,
                             nullptr),
                g_object_unref) {
    config_.address = "127.0.0.1";
    robot_.name = "r1";
    robot_.sensor = "top";
    robot_.port = FreePort();
  }
  void Make(GSocket* socket = nullptr) {
    session_ = std::make_unique<edge::Session>(config_, robot_, socket);
  }
  /// Polls the session at `since` after kBegin.
  void PollAt(Duration since) { session_->Poll(kBegin + since); }
  void Send(int packets, std::size_t size = 1'000) {
    const Object to(g_inet_socket_address_new_from_string("127.0.0.1", robot_.port),
                    g_object_unref);
    std::string packet(size, 'x');
    for (int i = 0; i < packets; ++i, ++seq_) {
      const char header[] = {
          '\x80', 96, static_cast<char>(seq_ >> 8), static_cast<char>(seq_), 0, 0, 0, 0, 0, 0,
          0,      7};
      packet.replace(0, sizeof header, header, sizeof header);
      g_socket_send_to(G_SOCKET(sender_.get()), G_SOCKET_ADDRESS(to.get()), packet.data(),
                       packet.size(), nullptr, nullptr);
    }
  }
  /// Waits until the session has received `packets` packets. Returns their bytes.
  std::uint64_t Received(std::uint64_t packets) {
    EXPECT_TRUE(Eventually([&] { return Source().value("packets-received", 0U) >= packets; }));
    return Source().value("bytes-received", std::uint64_t{0});
  }
  nlohmann::json Source() const { return Report().value("screamsrc", nlohmann::json::object()); }
  nlohmann::json Report() const {
    fleet::Exposition ignored;
    return session_->Tell(&ignored);
  }
  std::string Metrics() const {
    fleet::Exposition exposition;
    session_->Tell(&exposition);
    return exposition.text();
  }
  std::uint64_t Count(const char* name) const { return Report().at(name); }
  std::string state() const { return Report().at("state"); }

  gst::ElementPtr Find(const char* name) const {
    return gst::ElementPtr(gst_bin_get_by_name(GST_BIN(session_->pipeline()), name));
  }
  void Fail(const char* element) const {
    const gst::ElementPtr failing = Find(element);
    ASSERT_TRUE(failing) << element;
    GST_ELEMENT_ERROR(failing.get(), RESOURCE, FAILED, ("%s fails.", element), (nullptr));
  }
  bool records() const { return Find("recorder") != nullptr; }

  static constexpr Time kBegin{std::chrono::hours(1)};
  edge::EdgeConfig config_;
  edge::RobotConfig robot_;
  std::unique_ptr<edge::Session> session_;

 private:
  Object sender_;
  std::uint16_t seq_ = 0;
};

TEST_F(EdgeSession, ARobotAboveItsLimitIsShutOutUntilItsMeanIsBelow) {
  robot_.max_mbps = 0.008;  // 1,000 bytes/s
  Make();
  PollAt({});
  Duration at{};
  for (std::uint64_t session = 1; session <= 2; ++session) {
    ASSERT_EQ(Count("sessions"), session);
    EXPECT_EQ(state(), "waiting");
    Send(10);
    const auto excess = seconds(Received(10)) / 1'000.0;
    at += seconds(1);
    PollAt(at);
    ASSERT_EQ(state(), "resting");
    EXPECT_EQ(Count("penalties"), session);
    const Duration rest = std::chrono::duration_cast<Duration>(excess);
    PollAt(at + rest - milliseconds(1));
    EXPECT_EQ(Count("sessions"), session) << "it is shut out for " << Seconds(rest) << " s";
    at += rest + milliseconds(1);
    PollAt(at);
  }
  EXPECT_EQ(Count("sessions"), 3U);
  EXPECT_EQ(Count("failures"), 0U);
}

TEST_F(EdgeSession, ARobotThatIsSilentIsGoneAndMayComeAgainAtOnce) {
  Make();
  PollAt({});
  PollAt(seconds(100));
  EXPECT_EQ(state(), "waiting") << "there was no robot";
  EXPECT_NE(Metrics().find("lidar_edge_receiving{robot=\"r1\",sensor=\"top\"} 0\n"),
            std::string::npos);
  Send(2);
  Received(2);
  PollAt(seconds(101));
  EXPECT_EQ(state(), "receiving");
  EXPECT_NE(Metrics().find("lidar_edge_receiving{robot=\"r1\",sensor=\"top\"} 1\n"),
            std::string::npos);
  PollAt(seconds(111));
  EXPECT_EQ(state(), "receiving");
  PollAt(seconds(112));
  EXPECT_EQ(state(), "resting");
  PollAt(seconds(112));
  ASSERT_EQ(state(), "waiting");
  EXPECT_EQ(Count("sessions"), 2U);
  Send(2);
  Received(2);
  PollAt(seconds(113));
  EXPECT_EQ(state(), "receiving");
  gst_element_post_message(session_->pipeline(),
                           gst_message_new_eos(GST_OBJECT(session_->pipeline())));
  PollAt(seconds(114));
  EXPECT_EQ(state(), "resting") << "it said goodbye";
  PollAt(seconds(114));
  EXPECT_EQ(Count("sessions"), 3U);
  EXPECT_EQ(Count("failures") + Count("penalties"), 0U);
}

/// The pauses after failures that follow each other without a success [s].
constexpr int kPauses[] = {2, 4, 8, 16, 32, 64, 64};

TEST_F(EdgeSession, AfterEachFailureInARowThePauseIsLonger) {
  Make();
  PollAt({});
  Duration at{};
  std::uint64_t sessions = 1;
  const auto expect_pause = [&](int pause_s) {
    Fail("rtplidardepay");
    PollAt(at);
    EXPECT_EQ(state(), "resting");
    EXPECT_EQ(Count("failures"), sessions);
    EXPECT_EQ(Report().at("last-error"), "rtplidardepay: rtplidardepay fails.");
    PollAt(at + seconds(pause_s) - milliseconds(1));
    EXPECT_EQ(Count("sessions"), sessions) << pause_s;
    at += seconds(pause_s);
    PollAt(at);
    EXPECT_EQ(Count("sessions"), ++sessions) << pause_s;
  };
  for (const int pause_s : kPauses) expect_pause(pause_s);
  at += seconds(10);
  expect_pause(64);
  at += seconds(11);
  expect_pause(2);
}

TEST_F(EdgeSession, ARecorderThatFailsIsReplacedAndTheSessionGoesOn) {
  robot_.record = "/dev/null";
  Make();
  PollAt({});
  Duration at{};
  std::uint64_t failures = 0;
  const auto expect_pause = [&](int pause_s) {
    ASSERT_TRUE(records());
    Fail("mcapsink");
    Fail("queue");  // is a result of the sink's failure, so it is not counted
    PollAt(at);
    EXPECT_FALSE(records());
    EXPECT_EQ(Count("record-failures"), ++failures);
    EXPECT_EQ(Report().at("last-error"), "mcapsink: mcapsink fails.");
    PollAt(at + seconds(pause_s) - milliseconds(1));
    EXPECT_FALSE(records()) << pause_s;
    at += seconds(pause_s);
    PollAt(at);
    EXPECT_TRUE(records()) << pause_s;
  };
  for (const int pause_s : kPauses) expect_pause(pause_s);
  at += seconds(10);
  expect_pause(64);
  at += seconds(11);
  expect_pause(2);
  EXPECT_EQ(Count("sessions"), 1U);
  EXPECT_EQ(Count("failures"), 0U);
  Fail("rtplidardepay");
  PollAt(at);
  EXPECT_FALSE(records()) << "a rest has no recorder";
  PollAt(at + seconds(2));
  EXPECT_TRUE(records());
}

TEST_F(EdgeSession, TellsEachFigureByItsName) {
  robot_.record = "/dev/null";
  robot_.max_mbps = 0.008;
  Make();
  PollAt({});
  Duration at{};
  for (int i = 0; i < 4; ++i, at += seconds(100), PollAt(at)) {
    Fail("mcapsink");
    PollAt(at);
  }
  for (int i = 0; i < 3; ++i, at += seconds(100), PollAt(at)) {
    Fail("screamsrc");
    PollAt(at);
  }
  for (int i = 0; i < 2; ++i, at += seconds(100), PollAt(at)) {
    Send(10);
    Received(10);
    at += seconds(1);
    PollAt(at);
    ASSERT_EQ(state(), "resting");
  }
  const gst::ElementPtr tee = Find("tee");
  GST_ELEMENT_WARNING(tee.get(), RESOURCE, FAILED, ("All is well."), (nullptr));
  PollAt(at);
  const auto before = g_get_real_time() * 1'000;
  auto report = Report();
  EXPECT_GE(report["time"], before - 1'000'000'000);
  EXPECT_LE(report["time"], g_get_real_time() * 1'000);
  EXPECT_EQ(report["last-error"], "tee: All is well.");
  for (const char* element : {"screamsrc", "rtplidardepay", "mcapsink"})
    EXPECT_TRUE(report[element].is_object()) << element;
  EXPECT_FALSE(report.contains("natssink"));
  for (const char* shown : {"time", "last-error", "screamsrc", "rtplidardepay", "mcapsink"})
    report.erase(shown);
  EXPECT_EQ(report, nlohmann::json({{"robot", "r1"},
                                    {"sensor", "top"},
                                    {"state", "waiting"},
                                    {"sessions", 6},
                                    {"failures", 3},
                                    {"penalties", 2},
                                    {"record-failures", 4}}));
  const std::string metrics = Metrics();
  for (const char* line :
       {"receiving{robot=\"r1\",sensor=\"top\"} 0\n", "sessions{robot=\"r1\",sensor=\"top\"} 6\n",
        "failures{robot=\"r1\",sensor=\"top\"} 3\n", "penalties{robot=\"r1\",sensor=\"top\"} 2\n",
        "record_failures{robot=\"r1\",sensor=\"top\"} 4\n"})
    EXPECT_NE(metrics.find(std::string("\nlidar_edge_") + line), std::string::npos) << line;
}

TEST_F(EdgeSession, OnASharedPortHasNothingOfItsRest) {
  robot_.max_mbps = 0.008;
  robot_.ssrc = edge::SsrcRange{7, 7};
  const edge::SharedPort port("127.0.0.1", std::exchange(robot_.port, std::uint16_t{0}),
                              {*robot_.ssrc});
  const Object bound(g_socket_get_local_address(port.socket(0), nullptr), g_object_unref);
  const auto number = g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(bound.get()));
  Make(port.socket(0));
  robot_.port = number;  // Send() uses this port
  PollAt({});
  Send(10);
  const std::uint64_t size = Received(10) / 10;
  PollAt(seconds(1));
  ASSERT_EQ(state(), "resting");
  Send(10);
  PollAt(seconds(100));
  ASSERT_EQ(state(), "waiting");
  Send(1, 500);  // arrives after all packets that are still in the socket
  EXPECT_TRUE(Eventually([&] { return Received(1) % size != 0; }));
  EXPECT_EQ(Source().at("packets-received"), 1U) << "of the rest nothing came";
}

}  // namespace
}  // namespace lidar::test
