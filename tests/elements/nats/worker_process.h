// SPDX-License-Identifier: LGPL-2.1-or-later
// A lidar-worker process that a test starts, and functions that judge the poses that it publishes.
#pragma once
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <set>

#include "src/tools/common/child_process.h"
#include "tests/elements/nats/nats_pipeline.h"

namespace lidar::test {

constexpr double kSpeed = 10;  // of every robot [m/s]

/// Returns a pipeline of a robot that drives. Its sensor costs little processor time. The source is
/// not live, because a live source would skip scans on a busy machine.
inline std::string DrivingRobot(int frames = -1) {
  return "lidartestsrc model=os0-32 mode=512x10 speed=10 num-buffers=" + std::to_string(frames) +
         " ! clocksync ! lidarenc effort=0 key-interval=1000000000" + kSee;
}

class WorkerProcess {
 public:
  explicit WorkerProcess(const std::vector<std::string>& options) {
    std::vector<std::string> command = {std::getenv("LIDAR_WORKER")};
    command.insert(command.end(), options.begin(), options.end());
    process_ = std::make_unique<tools::ChildProcess>(
        tools::ChildProcess::Config{std::move(command), "", false});
  }

  /// Returns the names "robot.sensor" that the worker follows, according to its output so far.
  std::set<std::string> Robots() {
    Read();
    return robots_;
  }
  /// Returns the line that the worker printed when it first took `robot`, or an empty string if it
  /// has not taken it yet.
  std::string Taken(const std::string& robot) {
    Read();
    for (const std::string& line : lines_)
      if (line.rfind(robot + ": taken", 0) == 0) return line;
    return "";
  }
  /// Returns all lines that the worker has printed so far.
  const std::vector<std::string>& lines() {
    Read();
    return lines_;
  }
  bool Said(const std::string& line) {
    Read();
    return std::count(lines_.begin(), lines_.end(), line) > 0;
  }
  pid_t pid() const { return process_->pid(); }
  void Kill() {
    process_->Signal(SIGKILL);
    killed_ = true;
  }
  bool is_killed() const { return killed_; }
  int Stop() {
    process_->Signal(SIGTERM);
    return process_->Wait();
  }

 private:
  void Read() {
    process_->ReadLines([this](const std::string& line) {
      lines_.push_back(line);
      const std::string robot = line.substr(0, line.find(':'));
      if (line.find(": taken") != line.npos) robots_.insert(robot);
      if (line.find(": given up") != line.npos) robots_.erase(robot);
    });
  }

  std::unique_ptr<tools::ChildProcess> process_;
  bool killed_ = false;
  std::vector<std::string> lines_;
  std::set<std::string> robots_;
};

/// Returns the distance of a pose from the origin [m].
inline double DistanceOf(const Kept& pose) {
  double p[3] = {};
  if (pose.bytes.size() >= 64) std::memcpy(p, pose.bytes.data(), sizeof p);
  return std::hypot(p[0], p[1], p[2]);
}

/// Compares each pose with the next one: the difference of their distances from the origin, and the
/// distance that the robot drove between them. Returns the largest deviation [m].
inline double LargestJump(std::vector<Kept> poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const Kept& a, const Kept& b) { return a.capture_time < b.capture_time; });
  double largest = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto gap = static_cast<double>(poses[i].capture_time - poses[i - 1].capture_time) * 1e-9;
    const double step = DistanceOf(poses[i]) - DistanceOf(poses[i - 1]);
    largest = std::max(largest, std::abs(step - kSpeed * gap));
  }
  return largest;
}

/// Returns the distance by which the last pose is behind the true position of the robot, which
/// drives straight ahead from its first pose on [m].
inline double BehindBy(const std::vector<Kept>& poses) {
  const auto earlier = [](const Kept& a, const Kept& b) { return a.capture_time < b.capture_time; };
  const auto [first, last] = std::minmax_element(poses.begin(), poses.end(), earlier);
  if (first == poses.end()) return 0;
  const auto time = static_cast<double>(last->capture_time - first->capture_time) * 1e-9;
  return kSpeed * time - (DistanceOf(*last) - DistanceOf(*first));
}

/// Returns the poses that a single lidarodometry makes from the whole stream of `robot` in
/// JetStream.
inline std::vector<Kept> PosesInOneGo(const std::string& robot, const std::string& url) {
  NatsPipeline player("natssrc name=n eos-at-end=true start-time=0 jetstream=fleet subject=fleet." +
                      robot + ".lidar.front url=" + url +
                      " ! lidardec ! lidarodometry name=o ! fakesink sync=false async=false "
                      "o.odometry ! fakesink name=see sync=false async=false");
  player.Play();
  // Waits as long as poses arrive: a replay of ten minutes may take longer than one call of
  // WaitForEnd() waits.
  std::string end;
  std::size_t before = 0;
  do {
    before = player.count();
    end = player.WaitForEnd();
  } while (end == "nothing happens" && player.count() > before);
  EXPECT_EQ(end, "");
  return player.buffers();
}

}  // namespace lidar::test
