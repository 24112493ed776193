// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the statistics that the programs of a fleet publish.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "ext/nats/jetstream.h"
#include "src/tools/apps/fleet/exposition.h"
#include "src/tools/apps/fleet/metrics_server.h"
#include "src/tools/apps/fleet/reporter.h"
#include "src/tools/apps/fleet/statistics.h"
#include "src/tools/common/file_descriptor.h"
#include "src/tools/common/printable.h"
#include "tests/elements/nats/nats_client.h"
#include "tests/elements/nats/nats_server.h"
#include "tests/support/ipv6.h"

namespace lidar::test {
namespace {

TEST(FleetExposition, HasNumbersByTheirNames) {
  GstStructure* inner = gst_structure_new("inner", "n", G_TYPE_UINT, 2U, nullptr);
  const gst::StructurePtr owner(inner);
  const gst::StructurePtr stats(gst_structure_new(
      "s", "packets-lost", G_TYPE_UINT64, guint64{7}, "connected", G_TYPE_BOOLEAN, TRUE, "drained",
      G_TYPE_BOOLEAN, FALSE, "age", G_TYPE_UINT64, G_MAXUINT64, "reason", G_TYPE_STRING, "x", "no",
      G_TYPE_STRING, nullptr, "rate", G_TYPE_DOUBLE, 0.5, "int", G_TYPE_INT, -3, "int64",
      G_TYPE_INT64, gint64{-4}, "uint", G_TYPE_UINT, 5U, "inner", GST_TYPE_STRUCTURE, inner, "none",
      GST_TYPE_STRUCTURE, nullptr, nullptr));
  fleet::Exposition exposition;
  exposition.Add("natssink", "{robot=\"a\"}", stats.get());
  exposition.Add("lidar_edge_x", "", 1);
  using Limits = std::numeric_limits<double>;
  for (const double none : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()})
    exposition.Add("lidar_edge_y", "", none);
  std::string expected = "# TYPE lidar_edge_x untyped\nlidar_edge_x 1\n";
  for (const auto& [name, value] : std::map<std::string, std::string>{{"connected", "1"},
                                                                      {"drained", "0"},
                                                                      {"int", "-3"},
                                                                      {"int64", "-4"},
                                                                      {"rate", "0.5"},
                                                                      {"uint", "5"},
                                                                      {"packets_lost", "7"}})
    expected += "# TYPE lidar_natssink_" + name + " untyped\nlidar_natssink_" + name +
                "{robot=\"a\"} " + value + "\n";
  EXPECT_EQ(exposition.text(), expected);
  EXPECT_EQ(fleet::ToJson(stats.get()).dump(),
            R"({"connected":true,"drained":false,"inner":{"n":2},"int":-3,"int64":-4,)"
            R"("packets-lost":7,"rate":0.5,"reason":"x","uint":5})");
}

TEST(Printable, IsALineThatGivesATerminalNoOrders) {
  EXPECT_EQ(tools::Printable("r7: Gerät 1"), "r7: Gerät 1");
  EXPECT_EQ(tools::Printable("a\x1b[2J\nb\x7f"), "a\\x1b[2J\\x0ab\\x7f");
  EXPECT_EQ(tools::Printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(tools::Printable("\xff\xc3"), "\\xff\\xc3") << "no UTF-8";
  EXPECT_EQ(tools::Printable("\u009b"), "\\xc2\\x9b") << "begins an order in some terminals";
  EXPECT_EQ(tools::Printable(""), "");
}

tools::FileDescriptor NewSocket() {
  return tools::FileDescriptor(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
}

void Ask(const tools::FileDescriptor& client, int port, const std::string& request) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(client.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  send(client.get(), request.data(), request.size(), MSG_NOSIGNAL);
}

/// Returns the sockets of `count` clients that connected to `port` and sent `request`.
std::vector<tools::FileDescriptor> Clients(int port, std::size_t count,
                                           const std::string& request) {
  std::vector<tools::FileDescriptor> clients;
  for (std::size_t i = 0; i < count; ++i) {
    clients.push_back(NewSocket());
    Ask(clients.back(), port, request);
  }
  return clients;
}

/// Returns all bytes that arrive until the server closes the connection.
std::string Received(int fd) {
  std::string text;
  char bytes[1'024];
  for (ssize_t n; (n = recv(fd, bytes, sizeof bytes, 0)) > 0;)
    text.append(bytes, static_cast<std::size_t>(n));
  return text;
}

TEST(FleetMetrics, AreServedWhileHundredsOfClientsAreSilent) {
  fleet::MetricsServer server("127.0.0.1", 0, kPatience);
  server.Publish("lidar_edge_x 1\n");
  for (const char* part : {"", "GET /metrics HTTP/1.1\r\n"}) {
    const auto silent = Clients(server.port(), 300, part);
    const auto asking = Clients(server.port(), 1, "GET /metrics HTTP/1.1\r\n\r\n");
    const std::string answer = Received(asking[0].get());
    EXPECT_EQ(answer.substr(0, 15), "HTTP/1.1 200 OK");
    EXPECT_EQ(answer.substr(answer.find("\r\n\r\n") + 4), "lidar_edge_x 1\n");
    for (std::size_t i = 0; i < silent.size() - fleet::MetricsServer::kMaxConnections; ++i)
      EXPECT_EQ(Received(silent[i].get()), "") << "made room";
  }
  EXPECT_GE(server.cut(), 2 * (300 - fleet::MetricsServer::kMaxConnections));
}

TEST(FleetMetrics, CutOffWhoSaysNothingOrTooMuch) {
  fleet::MetricsServer server("127.0.0.1", 0);
  EXPECT_EQ(Received(Clients(server.port(), 1, "")[0].get()), "");
  EXPECT_EQ(server.cut(), 1U) << "the silent one";
  fleet::MetricsServer patient("127.0.0.1", 0, kPatience);
  EXPECT_EQ(Received(Clients(patient.port(), 1, std::string(100'000, 'x'))[0].get()), "");
  EXPECT_EQ(patient.cut(), 0U) << "it waits for the end of a request without an end";
}

TEST(FleetMetrics, CutOffTheOthersWhereNoFileDescriptorIsLeftForAnother) {
  fleet::MetricsServer server("127.0.0.1", 0, kPatience);
  server.Publish("lidar_edge_x 1\n");
  const auto silent = Clients(server.port(), 1, "");
  const auto answered = Clients(server.port(), 1, "GET /metrics HTTP/1.1\r\n\r\n");
  // The answer shows that the server has also accepted the silent client, which connected earlier.
  EXPECT_NE(Received(answered[0].get()), "");
  const tools::FileDescriptor next = NewSocket();
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit none = before;
  none.rlim_cur = static_cast<rlim_t>(tools::FileDescriptor(dup(0)).get());
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  Ask(next, server.port(), "GET /metrics HTTP/1.1\r\n\r\n");
  EXPECT_EQ(Received(silent[0].get()), "");
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(Received(next.get()).substr(0, 15), "HTTP/1.1 200 OK");
  EXPECT_EQ(server.cut(), 1U);
}

TEST(FleetMetrics, NameTheAddressThatAnotherProgramHas) {
  const fleet::MetricsServer first("127.0.0.1", 0);
  try {
    const fleet::MetricsServer second("127.0.0.1", first.port());
    FAIL() << "two have one port";
  } catch (const std::runtime_error& e) {
    EXPECT_EQ(e.what(), "cannot serve HTTP on 127.0.0.1:" + std::to_string(first.port()));
  }
  EXPECT_THROW(fleet::MetricsServer("192.0.2.1", 0), std::runtime_error) << "no address of ours";
}

TEST(FleetMetrics, AreAtTheirPathWithAndWithoutAQuery) {
  fleet::MetricsServer server("127.0.0.1", 0, kPatience);
  for (const auto& [line, status] :
       {std::pair{"GET /metrics HTTP/1.1", "200"}, std::pair{"GET /metrics?x=1 HTTP/1.0", "200"},
        std::pair{"GET / HTTP/1.1", "404"}, std::pair{"GET /metrics2 HTTP/1.1", "404"},
        std::pair{"GET /x/metrics HTTP/1.1", "404"}, std::pair{"POST /metrics HTTP/1.1", "404"}}) {
    const auto client = Clients(server.port(), 1, std::string(line) + "\r\nHost: x\r\n\r\n");
    EXPECT_EQ(Received(client[0].get()).substr(9, 3), status) << line;
  }
}

/// Many services have a name and a port that any program may use, for example http-alt. The server
/// must print the number of its port, not the name.
TEST(FleetMetrics, KnowTheirPortThoughItHasAName) {
  bool is_taken = true;
  setservent(1);
  for (const servent* s = getservent(); s != nullptr && is_taken; s = getservent()) {
    const int port = ntohs(static_cast<std::uint16_t>(s->s_port));
    if (port < 1'024 || std::string(s->s_proto) != "tcp") continue;
    try {
      EXPECT_EQ(fleet::MetricsServer("127.0.0.1", port).port(), port) << s->s_name;
      is_taken = false;
    } catch (const std::runtime_error&) {  // another program has the port
    }
  }
  endservent();
  if (is_taken) GTEST_SKIP() << "no such port is free";
}

TEST(FleetMetrics, ALargeTextArrivesWhole) {
  fleet::MetricsServer server("127.0.0.1", 0, kPatience);
  server.Publish(std::string(5'000'000, 'x'));
  const auto asking = Clients(server.port(), 1, "GET /metrics HTTP/1.0\r\n\r\n");
  EXPECT_GT(Received(asking[0].get()).size(), 5'000'000U);
}

using FleetReporter = NatsTest;

TEST_F(FleetReporter, SendsTheNewestAsSoonAsThereIsAServer) {
  server_.Start();
  nats::ConnectionSettings settings;
  settings.url = server_.url();
  std::string why;
  const auto connection = nats::Connection::Open(settings, nullptr, &why);
  ASSERT_TRUE(connection) << why;
  const auto js = nats::OpenJetStream(connection->get());
  nats::StreamSettings stream;
  stream.name = "told";
  ASSERT_TRUE(Eventually([&] { return nats::EnsureStream(js.get(), stream, {"told.>"}, &why); }))
      << why;
  server_.Kill();
  fleet::Reporter reporter(settings);
  reporter.Publish({{"told.r1", "old"}, {"told.r2", "old"}});
  reporter.Publish({{"told.r1", "new"}, {"told.r2", "new"}});
  server_.Restart();
  std::uint64_t number = 0;
  for (const char* subject : {"told.r1", "told.r2"}) {
    natsMsg* raw = nullptr;
    ASSERT_TRUE(Eventually([&] {
      return js_GetLastMsg(&raw, js.get(), "told", subject, nullptr, nullptr) == NATS_OK;
    })) << subject;
    const nats::MessagePtr last(raw);
    EXPECT_EQ(
        std::string(natsMsg_GetData(raw), static_cast<std::size_t>(natsMsg_GetDataLength(raw))),
        "new");
    EXPECT_EQ(natsMsg_GetSequence(raw), ++number) << "nothing else came";
  }
}

TEST_F(FleetReporter, TellsOfAServerThatRefusesUsOnceUntilOneTakesUs) {
  const auto errors = [this] { return server_.Logged("authentication error"); };
  server_.Start({"--auth", "other"});
  nats::ConnectionSettings settings;
  settings.url = server_.url();
  settings.token = "s3cret";
  testing::internal::CaptureStderr();
  {
    fleet::Reporter reporter(settings);
    // Each connection ends after the server has refused it twice. The next connection begins after
    // a pause.
    EXPECT_TRUE(Eventually([&] { return errors() >= 5; }));
    server_.Start({"--auth", "s3cret"});
    {
      const NatsClient client(server_.url("nats", "s3cret@"));
      const auto reports = client.Subscribe("told");
      natsMsg* raw = nullptr;
      EXPECT_TRUE(Eventually([&] {
        reporter.Publish({{"told", "x"}});
        return natsSubscription_NextMsg(&raw, reports.get(), 10) == NATS_OK;
      }));
      natsMsg_Destroy(raw);
    }
    server_.Start({"--auth", "other"});
    const std::size_t before = errors();
    EXPECT_TRUE(Eventually([&] { return errors() >= before + 3; }));
  }
  const std::string refusal =
      "Statistics are not sent to NATS: the server refused the connection: Authorization "
      "Violation\n";
  EXPECT_EQ(testing::internal::GetCapturedStderr(), refusal + refusal);
}

TEST(FleetStatistics, PrintAnAddressThatABrowserTakes) {
  if (!HasIpv6()) GTEST_SKIP() << "this machine has no IPv6";
  testing::internal::CaptureStdout();
  fleet::Statistics({"::1", 0, 5}, std::nullopt);
  const std::string told = testing::internal::GetCapturedStdout();
  EXPECT_EQ(told.rfind("metrics http://[::1]:", 0), 0U) << told;
}

/// Returns the value of the metric `name` in a text in the format of Prometheus.
double FigureIn(const std::string& text, const std::string& name) {
  const auto at = text.find("\n" + name + " ");
  return at == text.npos ? -1 : std::atof(text.c_str() + at + name.size() + 2);
}

TEST(FleetStatistics, AreCollectedOnceAnIntervalAndServed) {
  testing::internal::CaptureStdout();
  fleet::Statistics statistics({"127.0.0.1", 0, 3'600}, std::nullopt);
  const std::string told = testing::internal::GetCapturedStdout();
  const std::string host =
      "127.0.0.1:" + std::to_string(std::atoi(told.c_str() + told.rfind(':') + 1));
  int count = 0;
  const auto collect = [&](fleet::Exposition* exposition, fleet::Reporter::Reports*) {
    exposition->Add("lidar_count", "", ++count);
  };
  const auto processor_s = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  const double before_s = processor_s();
  for (int i = 0; i < 3; ++i) statistics.Poll(collect);
  EXPECT_EQ(count, 1);
  const double after_s = processor_s();
  std::string text;
  EXPECT_TRUE(Eventually([&] {
    text = HttpGet(host, "/metrics").value_or("");
    return !text.empty();
  }));
  EXPECT_EQ(FigureIn(text, "lidar_count"), 1);
  EXPECT_EQ(FigureIn(text, "lidar_http_connections_cut"), 0);
  EXPECT_GE(FigureIn(text, "process_cpu_seconds_total"), before_s - 0.1);
  EXPECT_LE(FigureIn(text, "process_cpu_seconds_total"), after_s + 0.1);
  EXPECT_GT(FigureIn(text, "process_resident_memory_bytes"), 1e6);
  EXPECT_LT(FigureIn(text, "process_resident_memory_bytes"), 1e11);
}

TEST(FleetStatistics, AreCollectedAgainAfterTheInterval) {
  testing::internal::CaptureStdout();
  fleet::Statistics statistics({"127.0.0.1", 0, 0.1}, std::nullopt);
  testing::internal::GetCapturedStdout();
  fleet::Statistics for_nobody({}, std::nullopt);
  int count = 0;
  const auto collect = [&](auto*, auto*) { ++count; };
  for_nobody.Poll(collect);
  EXPECT_EQ(count, 0);
  EXPECT_TRUE(Eventually([&] {
    statistics.Poll(collect);
    return count == 3;
  }));
}

TEST(Reporter, TellsOnceOfACertificateThatItCannotUse) {
  const std::string path = ::testing::TempDir() + "reporter-" + std::to_string(getpid());
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  nats::ConnectionSettings settings;
  settings.tls_ca_file = path;
  testing::internal::CaptureStderr();
  {
    const fleet::Reporter reporter(settings);
    for (const bool again : {true, false}) {
      // open() blocks until the other process opens the FIFO for reading.
      const tools::FileDescriptor certificate(open(path.c_str(), O_WRONLY));
      unlink(path.c_str());
      if (again) {
        EXPECT_EQ(mkfifo(path.c_str(), 0600), 0);
      } else {
        std::ofstream(path) << "x";
      }
      EXPECT_EQ(write(certificate.get(), "x", 1), 1);
    }
  }
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_NE(told.find("Statistics are not sent to NATS"), std::string::npos);
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1) << told;
  unlink(path.c_str());
}

}  // namespace
}  // namespace lidar::test
