// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/worker/worker.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "src/tools/common/event_loop.h"
#include "src/tools/common/printable.h"

namespace lidar::worker {
namespace {

using std::chrono::milliseconds;
using tools::Now;

constexpr milliseconds kStep{10};
constexpr std::chrono::seconds kAfterFailure{5};
// The sum of these two must stay below a second, because HandOver() may not take longer.
constexpr milliseconds kStopTimeout{400};
constexpr milliseconds kAnswerTimeout{300};
constexpr std::size_t kShownLetters = 300;  // most letters of a damaged record in a message

std::unique_ptr<nats::Connection> Connect(const WorkerSettings& settings) {
  nats::ConnectionSettings connection = settings.pipeline.connection;
  connection.name = settings.lease.worker;
  std::string why;
  auto opened = nats::Connection::Open(connection, nullptr, &why);
  if (!opened) throw std::runtime_error("NATS cannot be used: " + why);
  return opened;
}

void Say(const std::string& robot, const std::string& what) {
  std::printf("%s: %s\n", robot.c_str(), what.c_str());
  std::fflush(stdout);
}

void Warn(const std::string& robot, const std::string& what) {
  std::fprintf(stderr, "%s: %s\n", robot.c_str(), what.c_str());
}

}  // namespace

Worker::Worker(const WorkerSettings& settings)
    : settings_(settings),
      connection_(Connect(settings)),
      store_(connection_->get(), settings.fleet.bucket),
      table_(settings.lease),
      watch_(connection_.get(), settings.fleet) {
  // Makes a pipeline only to load the plugins, and to fail at once if a plugin is missing.
  const RobotPipeline try_it(settings_.pipeline, "robot.sensor", 0, std::nullopt);
}

void Worker::Step() {
  const nats::ConnectionState state = connection_->state();
  if (state.refused())
    throw std::runtime_error("the NATS server refused the connection: " + state.last_error);
  TakeNews();
  TakeAnswers();
  if (table_.MissesEntries(Now())) watch_.Renew();
  PollPipelines();
  FollowLeases();
  // Writes nothing while disconnected, because such writes would be outdated when they are sent.
  if (connection_->state().connected()) Send(table_.Poll(Now()));
}

void Worker::TakeNews() {
  const FleetWatch::News news = watch_.Take();
  for (const std::string& trouble : news.troubles)
    std::fprintf(stderr, "%s\n", tools::Printable(trouble).c_str());
  if (news.robots) {
    table_.SetRobots(*news.robots, Now());
    left_out_ = news.left_out;
    NoteStream(news.stream);
    first_ = news.first;
    CheckPlaces(news);
  }
  for (const FleetWatch::Entry& entry : news.entries) {
    const auto record = ParseLeaseRecord(entry.text);
    if (!record)
      Warn(entry.robot, "its lease record is damaged, so its last pose is not known: " +
                            tools::Printable(entry.text.substr(0, kShownLetters)));
    table_.OnEntry(entry.robot, entry.revision, record, Now());
  }
}

/// Drops all robots if the stream was replaced, even by a stream of the same name. Message numbers
/// are valid only in the stream that assigned them.
void Worker::NoteStream(std::uint64_t stream) {
  if (std::exchange(stream_, stream) == stream) return;
  for (const auto& [robot, pipeline] : pipelines_) table_.Drop(robot, Duration{0}, Now());
}

/// Gives up pipelines whose record names a scan that the stream does not have. A pipeline that
/// waited for this scan would send no poses. The next renewal corrects the record.
void Worker::CheckPlaces(const FleetWatch::News& news) {
  for (auto at = pipelines_.begin(); at != pipelines_.end();) {
    const RobotPipeline& pipeline = *at->second;
    if (pipeline.stream() != news.stream || !pipeline.IsAheadOf(news.last, news.asked_at)) {
      ++at;
      continue;
    }
    Warn(at->first,
         "its lease record names a message that the stream does not have; only the record's pose "
         "is used");
    Progress pose = pipeline.progress().value_or(*pipeline.begin());
    pose.stream = 0;  // the numbers are not valid in any stream
    table_.SetProgress(at->first, pose);
    at = GiveUp(at);
  }
}

void Worker::NoteProgress(const std::string& robot, const RobotPipeline& pipeline) {
  auto progress = pipeline.progress();
  if (!progress) return;
  progress->stream = pipeline.stream();
  table_.SetProgress(robot, *progress);
}

void Worker::TakeAnswers() {
  auto answer = store_.NextAnswer(kStep);
  for (; answer; answer = store_.NextAnswer(milliseconds(0))) {
    if (answer->revision)
      table_.OnStored(answer->ticket, *answer->revision, Now());
    else
      table_.OnRefused(answer->ticket, answer->newest, Now());
  }
}

void Worker::PollPipelines() {
  for (auto& [robot, pipeline] : pipelines_) {
    NoteProgress(robot, *pipeline);
    const std::string error = pipeline->Poll();
    if (error.empty()) continue;
    Warn(robot, error);
    ++counters_.failures;
    table_.LeaveToOthers(robot, kAfterFailure, Now());
  }
}

void Worker::FollowLeases() {
  for (auto at = ending_.begin(); at != ending_.end();)
    at = at->second.done.wait_for(milliseconds(0)) == std::future_status::ready ? ending_.erase(at)
                                                                                : std::next(at);
  const auto held = table_.HeldAt(Now());
  for (auto at = pipelines_.begin(); at != pipelines_.end();) {
    const auto lease = held.find(at->first);
    // A pipeline that dropped a pose, because its lease was renewed late, ends here. Another one
    // then begins at the scan of this pose.
    if (lease != held.end() && !at->second->has_dropped()) {
      at->second->SetEnd(lease->second.until);
      ++at;
      continue;
    }
    at = GiveUp(at);
  }
  for (const auto& [robot, lease] : held) {
    if (pipelines_.count(robot) > 0) continue;
    const auto last = ending_.find(robot);
    if (last == ending_.end()) Begin(robot, lease);
    // Another worker can begin at once.
    else if (Now() - last->second.since > settings_.lease.lease)
      table_.LeaveToOthers(robot, Duration{}, Now());
  }
}

void Worker::Begin(const std::string& robot, const LeaseTable::Held& held) {
  std::string from = "from now on";
  if (held.progress) {
    char text[100];
    const auto& p = held.progress->pose;
    std::snprintf(text, sizeof text, "from %.2f %.2f %.2f", p[0], p[1], p[2]);
    from = text;
  }
  Say(robot, "taken, " + from +
                 (held.last_worker.empty() ? "" : ", after " + tools::Printable(held.last_worker)));
  ++counters_.taken;
  auto begin = held.progress;
  // The stream may have dropped the scan to which the velocity belongs.
  if (begin && begin->scan < first_) begin->velocity.reset();
  try {
    auto pipeline = std::make_unique<RobotPipeline>(settings_.pipeline, robot, stream_, begin);
    pipeline->SetEnd(held.until);
    pipeline->Play();
    pipelines_[robot] = std::move(pipeline);
  } catch (const std::exception& e) {  // the process has no threads or files left
    Warn(robot, e.what());
    ++counters_.failures;
    NoteGivenUp(robot);
    table_.LeaveToOthers(robot, kAfterFailure, Now());
  }
}

void Worker::NoteGivenUp(const std::string& robot) {
  Say(robot, "given up");
  ++counters_.given_up;
}

Worker::Pipelines::iterator Worker::GiveUp(Pipelines::iterator at) {
  NoteGivenUp(at->first);
  return End(at);
}

Worker::Pipelines::iterator Worker::End(Pipelines::iterator at) {
  at->second->SetEnd(Time{});
  try {
    ending_[at->first] = {
        std::async(std::launch::async,
                   [pipeline = std::move(at->second)]() mutable { pipeline.reset(); }),
        Now()};
  } catch (const std::system_error&) {
    Warn(at->first, "no thread can be started to stop its pipeline, so all robots waited for it");
  }
  return pipelines_.erase(at);
}

void Worker::Send(const std::vector<LeaseTable::Write>& writes) {
  for (const LeaseTable::Write& write : writes)
    store_.Write(write.ticket, write.robot, write.replaces, write.text);
}

void Worker::Tell(fleet::Exposition* exposition, fleet::Reporter::Reports* reports) const {
  exposition->Add("lidar_worker_robots", "", static_cast<double>(pipelines_.size()));
  exposition->Add("lidar_worker_robots_taken", "", static_cast<double>(counters_.taken));
  exposition->Add("lidar_worker_robots_given_up", "", static_cast<double>(counters_.given_up));
  exposition->Add("lidar_worker_sensors_left_out", "", static_cast<double>(left_out_));
  exposition->Add("lidar_worker_failures", "", static_cast<double>(counters_.failures));
  for (const auto& [name, pipeline] : pipelines_) {
    const auto dot = name.find('.');
    const std::string robot = name.substr(0, dot);
    const std::string sensor = name.substr(dot + 1);
    nlohmann::json report = {{"robot", robot},
                             {"sensor", sensor},
                             {"time", g_get_real_time() * 1000},
                             {"worker", settings_.lease.worker}};
    pipeline->AddStats(fleet::RobotLabels(robot, sensor), exposition, &report);
    reports->emplace_back(settings_.fleet.prefix + "." + robot + ".worker." + sensor,
                          fleet::ToText(report));
  }
}

void Worker::WaitForEnds() {
  const Time deadline = Now() + kStopTimeout;
  for (auto& [robot, ending] : ending_)
    if (ending.done.wait_for(deadline - Now()) != std::future_status::ready)
      Warn(robot, "its pipeline does not stop in time; the robot is left to other workers anyway");
}

void Worker::HandOver() {
  for (auto at = pipelines_.begin(); at != pipelines_.end();) {
    at->second->SetEnd(Time{});
    NoteProgress(at->first, *at->second);
    at = End(at);
  }
  WaitForEnds();
  const Time deadline = Now() + kAnswerTimeout;
  const auto answered = [&] {
    while (table_.unanswered() > 0 && Now() < deadline) TakeAnswers();
  };
  answered();
  if (connection_->state().connected()) Send(table_.HandOver(Now()));
  answered();
}

}  // namespace lidar::worker
