// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs a pipeline for each robot whose lease is ours.
#pragma once
#include <future>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ext/nats/connection.h"
#include "src/tools/apps/fleet/exposition.h"
#include "src/tools/apps/fleet/reporter.h"
#include "src/tools/apps/worker/fleet_watch.h"
#include "src/tools/apps/worker/lease_store.h"
#include "src/tools/apps/worker/lease_table.h"
#include "src/tools/apps/worker/robot_pipeline.h"

namespace lidar::worker {

struct WorkerSettings {
  LeaseSettings lease;
  FleetSettings fleet;
  PipelineSettings pipeline;
};

/// For one thread.
class Worker {
 public:
  /// Throws std::runtime_error if settings are wrong or elements missing.
  explicit Worker(const WorkerSettings& settings);
  ~Worker() { connection_->Close(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Whether the connection was given up, so that only a new Worker can connect: see
  /// ConnectionState.
  bool unanswered() const { return connection_->state().unanswered; }
  /// Works for some milliseconds.
  void Step();
  /// Stops all pipelines, and leaves the robots to other workers, in less than a second. A
  /// pipeline that runs longer publishes nothing; the destructor waits for it.
  void HandOver();

  /// Adds the figures of the worker and of each robot that it has. Does not wait.
  void Tell(fleet::Exposition* exposition, fleet::Reporter::Reports* reports) const;

 private:
  using Pipelines = std::map<std::string, std::unique_ptr<RobotPipeline>>;
  struct Ending {
    std::future<void> done;
    Time since{};
  };

  void TakeNews();
  void NoteStream(std::uint64_t stream);
  void CheckPlaces(const FleetWatch::News& news);
  void NoteProgress(const std::string& robot, const RobotPipeline& pipeline);
  void TakeAnswers();
  void PollPipelines();
  void FollowLeases();
  void Begin(const std::string& robot, const LeaseTable::Held& held);
  void WaitForEnds();
  void NoteGivenUp(const std::string& robot);
  /// Ends a pipeline in the background, and prints that the robot is given up.
  Pipelines::iterator GiveUp(Pipelines::iterator at);
  Pipelines::iterator End(Pipelines::iterator at);
  void Send(const std::vector<LeaseTable::Write>& writes);

  const WorkerSettings settings_;
  std::unique_ptr<nats::Connection> connection_;
  LeaseStore store_;
  LeaseTable table_;
  std::uint64_t stream_ = 0;  // as in Progress
  std::uint64_t first_ = 0;   // number of its oldest message
  struct Counters {
    std::uint64_t taken = 0;
    std::uint64_t given_up = 0;
    std::uint64_t failures = 0;  // of pipelines
  } counters_;
  std::size_t left_out_ = 0;  // sensors beyond the bounds of FleetWatch
  Pipelines pipelines_;
  /// Pipelines that are stopping, which may take a while; others do not wait for them.
  std::map<std::string, Ending> ending_;
  FleetWatch watch_;  // declared last, so that its thread ends first
};

}  // namespace lidar::worker
