// SPDX-License-Identifier: LGPL-2.1-or-later
// Follows the leases in the key-value store and the list of robots, in a thread of its own because
// requests to an absent server block.
#pragma once
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "ext/nats/connection.h"
#include "ext/nats/nats_ptr.h"
#include "src/base/time.h"

namespace lidar::worker {

struct FleetSettings {
  std::string prefix = "fleet";  // of all subjects
  std::string stream = "fleet";  // the JetStream stream with the robots' messages
  std::string bucket = "lidar-workers";
  int replicas = 1;                   // of the bucket, if it must be created
  std::vector<std::string> patterns;  // of robots, with * and ?; "robot" or "robot.sensor"
};

class FleetWatch {
 public:
  struct Entry {
    std::string robot;
    std::uint64_t revision = 0;
    std::string text;
  };
  struct News {
    std::vector<Entry> entries;
    std::optional<std::set<std::string>> robots;  // "robot.sensor"; all within the bounds
    std::size_t left_out = 0;                     // number of sensors beyond the bounds
    std::uint64_t stream = 0;           // id of the stream with the robots, as in Progress
    std::uint64_t first = 0;            // number of its oldest message
    std::uint64_t last = 0;             // number of its newest message
    Time asked_at{};                    // time of the request: the answer is newer
    std::vector<std::string> troubles;  // that were not reported yet
  };

  FleetWatch(nats::Connection* connection, const FleetSettings& settings);
  ~FleetWatch();
  FleetWatch(const FleetWatch&) = delete;
  FleetWatch& operator=(const FleetWatch&) = delete;

  /// Makes Take() return all entries again.
  void Renew() { renew_ = true; }
  /// Returns the changes since the last call. Never waits.
  News Take();

 private:
  void Run();
  void Step();
  natsStatus MakeBucket();
  natsStatus Subscribe();
  void TakeEntry(natsMsg* message);
  void ListRobots();
  /// Reports `trouble` if it differs from `last`, and keeps it there. Reports no empty trouble.
  void Tell(std::string* last, const std::string& trouble);

  nats::Connection* const connection_;
  const FleetSettings settings_;
  nats::JetStreamPtr js_;
  nats::SubscriptionPtr entries_;
  unsigned connections_ = 0;  // count at the last subscription
  unsigned missed_heartbeats_ = 0;
  std::uint64_t last_number_ = 0;  // consumer's number of the last entry
  bool stale_ = true;              // there is no subscription, or it has a gap
  std::chrono::steady_clock::time_point renew_at_{};
  std::chrono::steady_clock::time_point list_at_{};
  std::string bucket_trouble_;
  std::string stream_trouble_;

  std::atomic<bool> stopping_{false};
  std::atomic<bool> renew_{false};
  std::mutex mutex_;  // guards news_
  News news_;
  std::thread thread_;
};

/// Whether `name` is a "robot.sensor" that fits a pattern.
bool IsWanted(const FleetSettings& settings, const std::string& name);
/// Greatest number of sensors per robot, as a publisher can invent sensors.
constexpr std::size_t kMostSensors = 16;
constexpr std::size_t kMostRobots = 4'096;
/// Keeps the first robots, and the first sensors of each, in the order of their names.
std::set<std::string> WithinBounds(const std::set<std::string>& all);
/// Returns "robot.sensor" for the subject of a LiDAR stream; empty for other subjects.
std::string RobotOf(const FleetSettings& settings, const std::string& subject);

}  // namespace lidar::worker
