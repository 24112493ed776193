// SPDX-License-Identifier: LGPL-2.1-or-later
// The processes of a fleet that tests kill, and what the processes reported before that.
#pragma once
#include <csignal>
#include <cstdlib>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ext/nats/answers.h"
#include "ext/nats/connection.h"
#include "src/tools/common/child_process.h"
#include "tests/elements/nats/fleet_books.h"
#include "tests/elements/nats/fleet_robots.h"
#include "tests/elements/nats/http_get.h"
#include "tests/elements/nats/nats_server.h"

namespace lidar::test {

/// A lidar-edge process that is killed and started again. Stores the last report of each session.
class EdgeProcess {
 public:
  EdgeProcess(nlohmann::json config, const std::string& folder) : path_(folder + "/edge.json") {
    config["http-port"] = 0;
    config["interval"] = 0.1;
    std::ofstream(path_) << config.dump();
  }

  /// Starts the process. Returns true once the process is ready, or false if that takes too long.
  bool Start() {
    process_ = std::make_unique<tools::ChildProcess>(
        tools::ChildProcess::Config{{std::getenv("LIDAR_EDGE"), path_}, path_ + ".log", false});
    port_ = 0;
    lives_.push_back({WallTime(), std::nullopt});
    return Eventually([this] {
      process_->ReadLines([this](const std::string& line) {
        if (line.rfind("metrics ", 0) == 0) port_ = std::atoi(line.c_str() + line.rfind(':') + 1);
      });
      return port_ > 0;
    });
  }
  void Kill() {
    process_->Signal(SIGKILL);
    process_->Wait();
    lives_.back().killed = WallTime();
    process_.reset();
  }
  bool is_up() const { return process_ != nullptr; }
  pid_t pid() const { return process_ ? process_->pid() : 0; }
  const std::vector<EdgeLife>& lives() const { return lives_; }
  /// Returns the sessions of `robot`, sorted by time.
  std::vector<SessionReport> SessionsOf(const std::string& robot) const {
    std::vector<SessionReport> sessions;
    const auto found = sessions_.find(robot);
    if (found != sessions_.end())
      for (const auto& [key, report] : found->second) sessions.push_back(report);
    return sessions;
  }

  /// Reads the edge's metrics and updates the reports of its sessions.
  void Sample() {
    if (!is_up()) return;
    const auto answer = HttpGet("127.0.0.1:" + std::to_string(port_), "/metrics");
    if (!answer) return;
    for (const auto& [robot, figures] : Parse(*answer)) Note(robot, figures);
  }
  std::uint64_t WaitingNow() const {
    std::uint64_t waiting = 0;
    for (const auto& [robot, sessions] : sessions_)
      if (!sessions.empty()) waiting += sessions.rbegin()->second.waiting;
    return waiting;
  }

 private:
  using Figures = std::map<std::string, std::uint64_t, std::less<>>;

  /// Parses lines such as: name{robot="r1",sensor="front"} 7
  static std::map<std::string, Figures> Parse(const std::string& text) {
    constexpr std::string_view kLabel = "{robot=\"";
    std::map<std::string, Figures> robots;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      const auto label = line.find(kLabel);
      if (label == line.npos) continue;
      const auto robot = label + kLabel.size();
      robots[line.substr(robot, line.find('"', robot) - robot)][line.substr(0, label)] =
          static_cast<std::uint64_t>(std::atof(line.c_str() + line.rfind(' ')));
    }
    return robots;
  }
  void Note(const std::string& robot, Figures f) {
    const double now = WallTime();
    SessionReport& report = sessions_[robot][{lives_.size() - 1, f["lidar_edge_sessions"]}];
    const auto sum = [&f](std::initializer_list<const char*> names) {
      std::uint64_t all = 0;
      for (const char* name : names) all += f[name];
      return all;
    };
    report.life = lives_.size() - 1;
    report.at = now;
    if (f["lidar_edge_receiving"] > 0) report.receiving_from = std::min(report.receiving_from, now);
    report.received = f["lidar_rtplidardepay_slices_received"];
    report.lost = sum({"lidar_rtplidardepay_slices_lost", "lidar_rtplidardepay_slices_damaged",
                       "lidar_rtplidardepay_slices_config_mismatch",
                       "lidar_rtplidardepay_slices_not_accepted"});
    report.dropped = sum({"lidar_natssink_messages_dropped", "lidar_natssink_messages_too_large",
                          "lidar_natssink_buffers_refused"});
    report.waiting = f["lidar_natssink_messages_waiting"];
    report.acknowledged = f["lidar_natssink_messages_acknowledged"];
  }

  const std::string path_;
  std::unique_ptr<tools::ChildProcess> process_;
  int port_ = 0;
  std::vector<EdgeLife> lives_;
  std::map<std::string, std::map<std::pair<std::size_t, std::uint64_t>, SessionReport>> sessions_;
};

/// Subscribes to the acknowledgements that the server sends to the publishers of a stream, and
/// stores them.
class AckWitness {
 public:
  AckWitness(const std::string& url, const std::string& stream)
      : sign_("\"stream\":\"" + stream + "\"") {
    nats::ConnectionSettings settings;
    settings.url = url;
    std::string why;
    connection_ = nats::Connection::Open(settings, nullptr, &why);
    EXPECT_TRUE(connection_) << why;
    natsSubscription* raw = nullptr;
    EXPECT_EQ(natsConnection_Subscribe(&raw, connection_->get(), "_INBOX.>", OnMessage, this),
              NATS_OK);
    subscription_ = nats::SubscriptionPtr(raw, {connection_->get()});
    natsSubscription_SetPendingLimits(raw, -1, -1);
  }
  /// Stops listening.
  void End() {
    subscription_.reset();
    connection_.reset();
  }

  std::size_t seen() const { return seen_.size(); }
  /// Counts the acknowledgements whose message is not in the stream. `by_sequence` has the slices
  /// of the stream by sequence number. A slice with another number or run is another message.
  std::size_t CountGone(const std::map<std::uint64_t, StoredSlice>& by_sequence) const {
    std::map<std::string, std::uint64_t> runs;
    return static_cast<std::size_t>(std::count_if(seen_.begin(), seen_.end(), [&](const Seen& ack) {
      const auto found = by_sequence.find(ack.sequence);
      if (found == by_sequence.end() || found->second.number != ack.number) return true;
      const auto run = runs.try_emplace(ack.inbox, found->second.run).first;
      return run->second != found->second.run;
    }));
  }

 private:
  struct Seen {
    std::string inbox;
    std::uint64_t number;
    std::uint64_t sequence;
  };

  static void OnMessage(natsConnection*, natsSubscription*, natsMsg* raw, void* data) {
    const nats::MessagePtr message(raw);
    auto* self = static_cast<AckWitness*>(data);
    const std::string_view subject(natsMsg_GetSubject(raw));
    const std::string_view text(natsMsg_GetData(raw),
                                static_cast<std::size_t>(natsMsg_GetDataLength(raw)));
    const auto dot = subject.rfind('.');
    const auto number = nats::ToNumber(subject.substr(dot + 1));
    if (!number || text.find(self->sign_) == text.npos) return;
    const auto answer = nlohmann::json::parse(text, nullptr, false);
    if (!answer.is_object() || !answer.contains("seq")) return;
    self->seen_.push_back({std::string(subject.substr(0, dot)), *number, answer["seq"]});
  }

  const std::string sign_;
  std::vector<Seen> seen_;  // the subscription's thread writes it until End()
  std::unique_ptr<nats::Connection> connection_;
  nats::SubscriptionPtr subscription_;
};

}  // namespace lidar::test
