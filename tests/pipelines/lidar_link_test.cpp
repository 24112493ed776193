// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests lidar-link as users run it: as a process that forwards packets from one socket to another.
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "src/tools/common/child_process.h"
#include "src/tools/common/event_loop.h"
#include "src/tools/common/udp_socket.h"

namespace lidar::tools {
namespace {
using namespace std::chrono_literals;

constexpr std::uint8_t kEct1 = 1;
constexpr std::uint8_t kCe = 3;
constexpr std::uint8_t kDscp = 46 << 2;

std::string Program() {
  const char* path = std::getenv("LIDAR_LINK");
  return path != nullptr ? path : "lidar-link";
}

struct Got {
  std::vector<std::uint8_t> payload;
  std::uint8_t tos = 0;
  Address from;
  Time at;
};

/// Returns the datagrams that arrive. Stops when there are `count` of them, or when none has
/// arrived for `silence`.
std::vector<Got> Receive(UdpSocket* socket, std::size_t count, Duration silence = 30s) {
  std::vector<Got> all;
  Time last = Now();
  while (all.size() < count && Now() < last + silence) {
    pollfd p{socket->fd(), POLLIN, 0};
    poll(&p, 1, 20);
    socket->ReceiveAll([&](const Datagram& d) {
      last = Now();
      all.push_back({{d.payload.begin(), d.payload.end()}, d.tos, *d.from, last});
    });
  }
  return all;
}

/// A line of the log. It describes a packet that arrived at the link.
struct Row {
  double at_ms = 0;
  double sojourn_ms = 0;
  int ecn_out = 0;
};

std::vector<Row> ReadLog(const std::string& name) {
  std::ifstream in(name);
  std::vector<Row> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<std::string> fields;
    std::istringstream text(line);
    for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
    EXPECT_EQ(fields.size(), 12U) << line;
    if (fields.size() == 12)
      rows.push_back({1e3 * std::stod(fields[0]), std::stod(fields[10]), std::stoi(fields[8])});
  }
  return rows;
}

class LidarLink : public testing::Test {
 protected:
  LidarLink() : receiver_(UdpSocket::Bind(ResolveAddress("127.0.0.1:0", ""))) {}

  void Start(std::vector<std::string> options) {
    std::vector<std::string> command{Program(),
                                     "--listen",
                                     "127.0.0.1:0",
                                     "--forward",
                                     "127.0.0.1:" + std::to_string(receiver_.LocalPort()),
                                     "--json-lines",
                                     "--summary",
                                     summary_};
    command.insert(command.end(), options.begin(), options.end());
    link_ = std::make_unique<ChildProcess>(ChildProcess::Config{command, "", false});
    ports_.clear();
    const Time end = Now() + 30s;
    while (ports_.empty() && Now() < end) {
      std::this_thread::sleep_for(5ms);
      link_->ReadLines([&](const std::string& line) {
        const auto record = nlohmann::json::parse(line, nullptr, false);
        if (record.contains("listening")) ports_ = record["listening"].get<std::vector<int>>();
      });
    }
    ASSERT_FALSE(ports_.empty()) << "lidar-link does not listen";
  }

  Address Port(std::size_t i) const {
    return ResolveAddress("127.0.0.1:" + std::to_string(ports_.at(i)), "");
  }
  UdpSocket Sender() const { return UdpSocket::Connect(Port(0)); }

  nlohmann::json Stop() {
    link_->Signal(SIGINT);
    EXPECT_EQ(link_->Wait(), 0);
    return nlohmann::json::parse(std::ifstream(summary_), nullptr, false);
  }

  static void Send(UdpSocket* socket, std::uint8_t first_byte, std::size_t size, std::uint8_t tos) {
    std::vector<std::uint8_t> payload(size);
    payload[0] = first_byte;
    EXPECT_TRUE(socket->Send({payload.data(), payload.size()}, tos, nullptr));
  }

  /// Sends a marker behind the packets that were sent, and returns all datagrams up to the arrival
  /// of `copies` copies of the marker. If the link drops the marker, another marker is sent.
  std::vector<Got> ReceiveToTheEnd(UdpSocket* sender, int copies = 1) {
    std::vector<Got> all;
    for (int marker = 200; marker < 256; ++marker) {
      Send(sender, static_cast<std::uint8_t>(marker), 100, 0);
      ++markers_;
      int came = 0;
      std::vector<Got> next;
      do {
        next = Receive(&receiver_, 1, 1s);
        for (const Got& g : next) came += g.payload[0] == marker ? 1 : 0;
        all.insert(all.end(), next.begin(), next.end());
      } while (came < copies && !next.empty());
      if (came == copies) return all;
    }
    ADD_FAILURE() << "no marker arrives";
    return all;
  }

  UdpSocket receiver_;
  std::size_t markers_ = 0;
  const std::string summary_ = testing::TempDir() + "lidar_link_summary.json";
  std::unique_ptr<ChildProcess> link_;
  std::vector<int> ports_;
};

TEST_F(LidarLink, CarriesPayloadEcnAndDscpThereAndTheAnswerBackAfterOneRtt) {
  Start({"--rate", "100", "--rtt", "40"});
  auto sender = Sender();
  // A busy machine may delay single packets, but not all packets of half a minute. So the least
  // delay is checked.
  Duration best = 1h;
  const Time end = Now() + 30s;
  std::uint8_t i = 0;
  for (; i < 10 || (best > 44ms && i < 250 && Now() < end); ++i) {
    const Time sent = Now();
    Send(&sender, i, 500, kDscp | kEct1);
    const auto there = Receive(&receiver_, 1);
    ASSERT_EQ(there.size(), 1U);
    EXPECT_EQ(there[0].payload.size(), 500U);
    EXPECT_EQ(there[0].payload[0], i);
    EXPECT_EQ(there[0].tos, kDscp | kEct1);
    EXPECT_TRUE(receiver_.Send({&i, 1}, 0, &there[0].from));
    const auto back = Receive(&sender, 1);
    ASSERT_EQ(back.size(), 1U);
    EXPECT_EQ(back[0].payload, std::vector<std::uint8_t>{i});
    EXPECT_GE(back[0].at - sent, 40ms);
    best = std::min(best, back[0].at - sent);
  }
  EXPECT_LE(best, 44ms);
  const auto summary = Stop();
  EXPECT_EQ(summary["delivered"], i);
  EXPECT_EQ(summary["feedback"]["packets"], i);
}

TEST_F(LidarLink, SerialisesABurstAtItsRateAndMarksWhatWaitsTooLong) {
  // A packet has 972 + 28 bytes and takes 10 ms at 0.8 Mbit/s. Even a sender that is slow because
  // the machine is busy sends faster than that, so a queue builds up.
  const std::string log = testing::TempDir() + "lidar_link_burst.csv";
  Start({"--rate", "0.8", "--rtt", "0", "--aqm", "step", "--aqm-high", "95", "--log", log});
  auto sender = Sender();
  const Time sent = Now();
  for (std::uint8_t i = 0; i < 50; ++i) Send(&sender, i, 972, kEct1);
  const auto got = Receive(&receiver_, 50);
  ASSERT_EQ(got.size(), 50U);
  EXPECT_GE(got.back().at - sent, 500ms);
  const auto marked =
      std::count_if(got.begin(), got.end(), [](const Got& g) { return g.tos == kCe; });
  EXPECT_GT(marked, 0);
  const auto summary = Stop();
  EXPECT_EQ(summary["marked"], marked);
  EXPECT_EQ(summary["ecn_out"]["ce"], marked);
  // A packet waits until the link has sent the packets before it. The expected waiting time is
  // computed from the arrival times in the log, so a slow sender or link does not change the
  // result.
  const auto rows = ReadLog(log);
  ASSERT_EQ(rows.size(), 50U);
  double free_ms = 0;
  double longest_ms = 0;
  for (const Row& row : rows) {
    EXPECT_NEAR(row.sojourn_ms, std::max(free_ms - row.at_ms, 0.0), 0.01);
    EXPECT_EQ(row.ecn_out, row.sojourn_ms > 95 ? kCe : kEct1) << row.sojourn_ms;
    free_ms = row.at_ms + row.sojourn_ms + 10;
    longest_ms = std::max(longest_ms, row.sojourn_ms);
  }
  EXPECT_NEAR(summary["sojourn_ms"]["max"].get<double>(), longest_ms, 0.01);
}

TEST_F(LidarLink, LeavesPacketsWithoutEcnUnmarkedAndDropsTheTail) {
  Start({"--rate", "0.8", "--rtt", "0", "--aqm", "step", "--aqm-high", "1", "--queue", "100"});
  auto sender = Sender();
  for (std::uint8_t i = 0; i < 50; ++i) Send(&sender, i, 972, 0);
  const auto got = ReceiveToTheEnd(&sender);
  EXPECT_GE(got.size(), 10U);
  for (const Got& g : got) EXPECT_EQ(g.tos, 0);
  const auto summary = Stop();
  EXPECT_GT(summary["queue_full"], 0);
  EXPECT_EQ(summary["queue_full"].get<std::size_t>() + got.size(), 50 + markers_);
}

TEST_F(LidarLink, MarksEct1AsSeldomAsEct0WhereItKnowsNoL4s) {
  // The link needs 160 ms for the burst. It marks a classic packet with the square of the
  // probability that it uses for L4S, so it marks fewer classic packets.
  const auto marks = [this](std::vector<std::string> options) {
    options.insert(options.end(),
                   {"--rtt", "0", "--rate", "2", "--aqm", "pi2", "--aqm-target", "5"});
    Start(options);
    auto sender = Sender();
    for (std::uint8_t i = 0; i < 40; ++i) Send(&sender, i, 1000, kEct1);
    EXPECT_EQ(Receive(&receiver_, 40).size(), 40U);
    return Stop()["marked"].get<int>();
  };
  const int l4s = marks({});
  const int classic = marks({"--aqm-classic"});
  EXPECT_GT(l4s, 10);
  EXPECT_LT(classic, l4s / 2);
}

TEST_F(LidarLink, AnOutageHoldsPacketsUntilTheLinkIsBack) {
  Start({"--rtt", "0", "--outage", "0:0.3"});
  auto sender = Sender();
  const Time sent = Now();
  Send(&sender, 0, 100, kEct1);
  const auto got = Receive(&receiver_, 1);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_GE(got[0].at - sent, 300ms);
}

TEST_F(LidarLink, KeepsTwoSendersApartAndGivesEachItsAnswers) {
  Start({"--rtt", "0"});
  auto first = Sender();
  auto second = Sender();
  Send(&first, 1, 100, kEct1);
  Send(&second, 2, 100, kEct1);
  const auto got = Receive(&receiver_, 2);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_FALSE(got[0].from == got[1].from);
  for (const Got& g : got) receiver_.Send({g.payload.data(), 1}, 0, &g.from);
  EXPECT_EQ(Receive(&first, 1).at(0).payload[0], 1);
  EXPECT_EQ(Receive(&second, 1).at(0).payload[0], 2);
  EXPECT_EQ(Stop()["flows"].size(), 2U);
}

TEST_F(LidarLink, KeepsTwoPortsOfOneSenderApart) {
  auto other = UdpSocket::Bind(ResolveAddress("127.0.0.1:0", ""));
  const std::string second = "127.0.0.1:" + std::to_string(other.LocalPort());
  Start({"--rtt", "0", "--listen", "127.0.0.1:0", "--forward", second});
  ASSERT_EQ(ports_.size(), 2U);
  auto sender = UdpSocket::Bind(ResolveAddress("127.0.0.1:0", ""));
  for (std::uint8_t i = 0; i < 2; ++i) {
    const Address to = Port(i);
    EXPECT_TRUE(sender.Send({&i, 1}, kEct1, &to));
    const auto got = Receive(i == 0 ? &receiver_ : &other, 1);
    ASSERT_EQ(got.size(), 1U) << "port " << int{i};
    EXPECT_EQ(got[0].payload[0], i);
  }
}

TEST_F(LidarLink, DuplicatesAndLosesOnRequest) {
  Start({"--rtt", "0", "--rate", "1000", "--duplicate", "100", "--loss", "50"});
  auto sender = Sender();
  for (int i = 0; i < 200; ++i) Send(&sender, static_cast<std::uint8_t>(i), 100, kEct1);
  const auto got = ReceiveToTheEnd(&sender, 2);
  EXPECT_NEAR(static_cast<double>(got.size()), 200, 60);
  const auto summary = Stop();
  EXPECT_EQ(summary["delivered"].get<std::size_t>() * 2, got.size());
  EXPECT_EQ(summary["duplicated"], summary["delivered"]);
}

TEST_F(LidarLink, StopsAfterItsDuration) {
  Start({"--rtt", "0", "--duration", "0.2"});
  auto sender = Sender();
  Send(&sender, 0, 100, kEct1);
  EXPECT_EQ(link_->Wait(), 0);
}

TEST(LidarLinkUsage, APortInUseEndsWithCode1) {
  const auto taken = UdpSocket::Bind(ResolveAddress("127.0.0.1:0", ""));
  ChildProcess process({{Program(), "--listen", "127.0.0.1:" + std::to_string(taken.LocalPort())},
                        "/dev/null",
                        false});
  EXPECT_EQ(process.Wait(), 1);
}

}  // namespace
}  // namespace lidar::tools
