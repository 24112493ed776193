// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of ouster_src with HTTP servers that are not sensors. The element reports an error, limits
// its memory and time, and can be stopped.
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/elements/ouster/hostile_server.h"
#include "tests/elements/ouster/live_receiver.h"
#include "tests/support/element_stats.h"
#include "tests/support/metronome.h"
#include "tests/support/scarce_threads.h"

namespace lidar::test {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kMebibyte = std::size_t{1} << 20;
constexpr const char* kOk = "HTTP/1.1 200 OK\r\n";

std::string Repeat(const std::string& piece, std::size_t bytes) {
  std::string text;
  while (text.size() + piece.size() <= bytes) text += piece;
  return text;
}

struct Attack {
  const char* name;
  HostileServer::Behaviour behave;
};
void PrintTo(const Attack& attack, std::ostream* to) { *to << attack.name; }

const Attack kAttacks[] = {
    {"NeverAnswers",
     [](const Exchange& e) {
       while (e.Wait(milliseconds(20))) continue;
     }},
    {"AnswersAByteATime",
     [](const Exchange& e) {
       e.Send("HTTP/1.1 200 OK\r\nContent-Length: 1000000\r\n\r\n");
       while (e.Send(" ") && e.Wait(milliseconds(20))) continue;
     }},
    {"SendsHeadersWithoutEnd",
     [](const Exchange& e) {
       const std::string header = "X-Pad: " + std::string(1000, 'x') + "\r\n";
       e.Send(kOk);
       while (e.Send(header)) continue;
     }},
    {"SendsABodyWithoutEnd",
     [](const Exchange& e) {
       e.Send(std::string(kOk) + "\r\n");
       const std::string piece(65536, '[');
       while (e.Send(piece)) continue;
     }},
    {"AnnouncesMoreThanThereIsMemory",
     [](const Exchange& e) {
       e.Send(std::string(kOk) + "Content-Length: 1000000000000\r\n\r\n");
       while (e.Send(std::string(65536, ' '))) continue;
     }},
    {"SendsAMebibyteOfObjects",
     [](const Exchange& e) { e.Answer("{\"a\":[" + Repeat("{},", kMebibyte - 20) + "{}]}"); }},
    {"SendsAMebibyteOfDepth",
     [](const Exchange& e) { e.Answer(Repeat("{\"sensor_info\":", kMebibyte)); }},
    {"SendsAMebibyteOfClosedDepth",
     [](const Exchange& e) {
       const std::size_t levels = kMebibyte / 18;
       std::string text;
       for (std::size_t i = 0; i < levels; ++i) text += "{\"sensor_info\":";
       e.Answer(text + "1" + std::string(levels, '}'));
     }},
    {"SendsWhatIsNoText",
     [](const Exchange& e) {
       e.Send("HTTP/1.1 400 \xff\xfe\r\nContent-Length: 3\r\n\r\n\xff\xfe\xfd");
     }},
    {"ClosesAtOnce", [](const Exchange&) {}},
};

class OusterServer : public ::testing::TestWithParam<Attack> {};

void AwaitRequest(const HostileServer& server, int earlier) {
  ASSERT_TRUE(Eventually([&] { return server.requests() > earlier; }));
}

/// Stops the element `wait_ms` after its first request. Returns the time that the stop takes.
std::chrono::milliseconds TimeToStop(const HostileServer& server, const char* properties,
                                     guint wait_ms) {
  const int earlier = server.requests();
  Receiver receiver(server.host(), properties);
  AwaitRequest(server, earlier);
  g_usleep(wait_ms * 1000);
  const Metronome metronome;
  receiver.SetState(GST_STATE_NULL);
  return metronome.elapsed();
}

TEST_P(OusterServer, DoesNotKeepTheElementFromStopping) {
  const HostileServer server(GetParam().behave);
  for (const guint wait_ms : {0U, 50U, 300U})
    EXPECT_LT(TimeToStop(server, "", wait_ms).count(), 1'000) << wait_ms;
}

TEST_P(OusterServer, DoesNotKeepAReconfigurationFromStopping) {
  const HostileServer server(GetParam().behave);
  EXPECT_LT(TimeToStop(server, "udp-dest=@auto lidar-mode=1024x10", 100).count(), 1'000);
}

TEST_P(OusterServer, IsSaidToBeNoSensor) {
  const HostileServer server(GetParam().behave);
  Receiver receiver(server.host(), "reconnect=false");
  const std::string error = receiver.AwaitError();
  EXPECT_TRUE(error.find(server.host()) != std::string::npos ||
              error.find("the sensor did not apply") != std::string::npos)
      << error;
}

INSTANTIATE_TEST_SUITE_P(All, OusterServer, ::testing::ValuesIn(kAttacks),
                         [](const ::testing::TestParamInfo<Attack>& attack) {
                           return std::string(attack.param.name);
                         });

/// The element sends at most one request per second to a sensor's API, whatever packets arrive.
TEST(OusterQuestions, AreAsFewAsSeconds) {
  const Receiver::Ports ports{FreePort(), FreePort()};
  std::ifstream file(DataPath("OS-1-128_v2.3.0_1024x10.json"));
  auto answer = nlohmann::json::parse(file);
  answer["udp_port_lidar"] = ports.lidar;
  answer["udp_port_imu"] = ports.imu;
  const std::string text = answer.dump();
  const HostileServer server([&text](const Exchange& e) { e.Answer(text); });
  Receiver receiver(server.host(), "", ports);
  ASSERT_TRUE(receiver.Await("ouster-metadata-changed"));
  const int of_a_question = server.requests();
  const gint64 begin = g_get_monotonic_time();
  UdpSender sender(ports.lidar);
  guint64 sent = 0;
  const auto send = [&](int packets) {
    for (int i = 0; i < packets; ++i) {
      sender.Send(std::vector<std::uint8_t>(1'000));
      ++sent;
      EXPECT_TRUE(
          Eventually([&] { return StatOf(receiver.source(), "packets-wrong-size") == sent; }));
    }
  };
  send(10);
  ASSERT_TRUE(Eventually([&] { return server.requests() >= 2 * of_a_question; }));
  send(500);
  const int requests = server.requests();
  const gint64 seconds = (g_get_monotonic_time() - begin) / G_USEC_PER_SEC + 1;
  EXPECT_LE(requests, of_a_question * (1 + seconds));
}

/// A sensor whose API can report that the sensor is switched off. The test chooses what the API
/// reports.
class ChangingAnswers {
 public:
  explicit ChangingAnswers(const Receiver::Ports& ports) : sender_(ports.lidar) {
    std::ifstream file(DataPath(kThreeScansMetadata));
    auto answer = nlohmann::json::parse(file);
    answer["udp_port_lidar"] = ports.lidar;
    answer["udp_port_imu"] = ports.imu;
    texts_[0] = answer.dump();
    answer["udp_dest"] = "";
    texts_[1] = answer.dump();
  }
  enum Answer { kWhole, kSwitchedOff };
  void Say(Answer answer) { answer_ = answer; }
  std::string host() const { return server_.host(); }
  void SendLidar() { sender_.Send(packet_); }
  /// Sends four packets of another size. After such packets the element sends a request to the API.
  void SendWrongSizes() {
    for (int i = 0; i < 4; ++i) sender_.Send(std::vector<std::uint8_t>(1'000));
  }

 private:
  std::string texts_[2];
  std::atomic<int> answer_{kWhole};
  const HostileServer server_{[this](const Exchange& e) { e.Answer(texts_[answer_]); }};
  UdpSender sender_;
  const std::vector<std::uint8_t> packet_ =
      LoadPackets(kThreeScans, LoadMetadata(kThreeScansMetadata)).front();
};

TEST(OusterAnswers, OfASensorThatWasSwitchedOffAreAnErrorOnlyWithoutReconnect) {
  for (const bool reconnect : {true, false}) {
    const Receiver::Ports ports{FreePort(), FreePort()};
    ChangingAnswers sensor(ports);
    Receiver receiver(sensor.host(), reconnect ? "" : "reconnect=false", ports,
                      Receiver::Clock::kTest);
    ASSERT_TRUE(receiver.Await("ouster-metadata-changed"));
    sensor.SendLidar();
    ASSERT_TRUE(receiver.AwaitConnected(true));
    sensor.Say(ChangingAnswers::kSwitchedOff);
    sensor.SendWrongSizes();
    if (!reconnect) {
      EXPECT_EQ(receiver.AwaitError(), "The sensor's lidar stream is switched off.");
      continue;
    }
    const gst::MessagePtr lost = receiver.Await("ouster-connection-changed");
    ASSERT_TRUE(lost);
    EXPECT_STREQ(gst_structure_get_string(gst_message_get_structure(lost.get()), "reason"),
                 "the sensor's lidar stream is switched off");
    sensor.SendLidar();
    EXPECT_TRUE(receiver.AwaitConnected(true));
  }
}

TEST(OusterHostname, MayNameAnInterfaceOrAskForTls) {
  const HostileServer server([](const Exchange& e) { e.Answer("no TLS"); });
  for (const std::string& host : {"https://" + server.host(), std::string("[fe80::1%lo]:1")}) {
    Receiver receiver(host, "reconnect=false", {0, 0});
    const std::string error = receiver.AwaitError();
    EXPECT_EQ(error.rfind("Cannot talk to the sensor " + host + ": ", 0), 0U) << error;
  }
}

/// Returns the error of an ouster_src that cannot start while an object of type Scarcity exists.
template <class Scarcity>
std::string ErrorAmid() {
  const gst::ElementPtr source(
      GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make("ouster_src", nullptr))));
  g_object_set(source.get(), "hostname", "127.0.0.1:1", nullptr);
  const ElementBus bus(source.get());
  {
    const Scarcity scarce;
    EXPECT_EQ(gst_element_set_state(source.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  }
  const gst::MessagePtr message = bus.Pop(GST_MESSAGE_ERROR);
  const std::string text = message ? TextOf(message.get()) : "no error";
  gst_element_set_state(source.get(), GST_STATE_NULL);
  return text;
}

TEST(OusterThread, ThatCannotBeStartedIsAnElementError) {
  const std::string error = ErrorAmid<ScarceThreads>();
  EXPECT_NE(error.find("cannot start a thread"), std::string::npos) << error;
}

/// Limits the process to ten more open files, as `ulimit -n` does.
class ScarceFiles {
 public:
  ScarceFiles() {
    getrlimit(RLIMIT_NOFILE, &before_);
    const int next = dup(0);
    close(next);
    rlimit limit = before_;
    limit.rlim_cur = static_cast<rlim_t>(next) + 10;
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  ~ScarceFiles() { setrlimit(RLIMIT_NOFILE, &before_); }
  ScarceFiles(const ScarceFiles&) = delete;
  ScarceFiles& operator=(const ScarceFiles&) = delete;

 private:
  rlimit before_{};
};

TEST(OusterFiles, ThatMayNotBeOpenedAreAnElementError) {
  const std::string error = ErrorAmid<ScarceFiles>();
  EXPECT_NE(error.find("ulimit -n"), std::string::npos) << error;
}

TEST(OusterFirmware, ThatIsTooOldIsAnError) {
  const HostileServer server(
      [](const Exchange& e) { e.Send("HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n"); });
  for (const std::string& host : {server.host(), "http://" + server.host() + "/"}) {
    Receiver receiver(host, "", {0, 0});
    const std::string error = receiver.AwaitError();
    EXPECT_NE(error.find("its firmware may be older than 2.1"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace lidar::test
