// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs a pipeline for each robot that this worker leases.
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

/// Leases robots and computes their poses. Only one thread may use it.
class Worker {
 public:
  /// Throws std::runtime_error if a setting is wrong or an element is missing.
  explicit Worker(const WorkerSettings& settings);
  ~Worker() { connection_->Close(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Returns true if the connection was given up (see ConnectionState). Then only a new Worker can
  /// connect.
  bool unanswered() const { return connection_->state().unanswered; }
  /// Does the work that is due. This takes some milliseconds.
  void Step();
  /// Stops all pipelines and frees the robots for other workers, in less than a second. A pipeline
  /// that takes longer to stop publishes nothing more, and the destructor waits for it.
  void HandOver();

  /// Adds the figures of the worker and those of each robot that it follows. Does not wait.
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
  /// Ends a pipeline in the background, and prints that the worker has given up the robot.
  Pipelines::iterator GiveUp(Pipelines::iterator at);
  Pipelines::iterator End(Pipelines::iterator at);
  void Send(const std::vector<LeaseTable::Write>& writes);

  const WorkerSettings settings_;
  std::unique_ptr<nats::Connection> connection_;
  LeaseStore store_;
  LeaseTable table_;
  std::uint64_t stream_ = 0;  // creation time of the JetStream stream, as in Progress
  std::uint64_t first_ = 0;   // number of the oldest message in the stream
  struct Counters {
    std::uint64_t taken = 0;
    std::uint64_t given_up = 0;
    std::uint64_t failures = 0;  // number of pipelines that failed
  } counters_;
  std::size_t left_out_ = 0;  // number of sensors beyond the bounds of FleetWatch
  Pipelines pipelines_;
  /// Pipelines that are stopping. Each has a thread for this, because stopping may take a while.
  std::map<std::string, Ending> ending_;
  FleetWatch watch_;  // declared last, so that its thread ends first
};

}  // namespace lidar::worker
