// SPDX-License-Identifier: LGPL-2.1-or-later
// Follows the leases in the key-value store and the list of robots. Has a thread of its own,
// because requests block while the server is absent.
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
  std::string prefix = "fleet";  // first word of all subjects
  std::string stream = "fleet";  // the JetStream stream with the robots' messages
  std::string bucket = "lidar-workers";
  int replicas = 1;                   // number of replicas of the bucket, if it must be created
  std::vector<std::string> patterns;  // patterns of "robot" or "robot.sensor", with * and ?
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
    std::optional<std::set<std::string>> robots;  // all "robot.sensor" within the bounds
    std::size_t left_out = 0;                     // number of sensors beyond the bounds
    std::uint64_t stream = 0;           // creation time of the robots' stream, as in Progress
    std::uint64_t first = 0;            // number of the oldest message in the stream
    std::uint64_t last = 0;             // number of the newest message in the stream
    Time asked_at{};                    // time at which the list was requested
    std::vector<std::string> troubles;  // errors that were not reported yet
  };

  FleetWatch(nats::Connection* connection, const FleetSettings& settings);
  ~FleetWatch();
  FleetWatch(const FleetWatch&) = delete;
  FleetWatch& operator=(const FleetWatch&) = delete;

  /// Makes Take() return all entries again.
  void Renew() { renew_ = true; }
  /// Returns the changes since the last call of Take(). Never waits.
  News Take();

 private:
  void Run();
  void Step();
  natsStatus MakeBucket();
  natsStatus Subscribe();
  void TakeEntry(natsMsg* message);
  void ListRobots();
  /// Reports `trouble` if it differs from `last` and is not empty. Stores it in `last`.
  void Tell(std::string* last, const std::string& trouble);

  nats::Connection* const connection_;
  const FleetSettings settings_;
  nats::JetStreamPtr js_;
  nats::SubscriptionPtr entries_;
  unsigned connections_ = 0;  // number of connects at the time of the last subscription
  unsigned missed_heartbeats_ = 0;
  std::uint64_t last_number_ = 0;  // number that the consumer gave the last entry
  bool stale_ = true;              // there is no subscription, or it has missed an entry
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

/// Returns true if `name` is a "robot.sensor" that matches a pattern of the settings.
bool IsWanted(const FleetSettings& settings, const std::string& name);
/// The greatest number of sensors of a robot. It is limited, because a publisher can invent
/// sensors.
constexpr std::size_t kMostSensors = 16;
constexpr std::size_t kMostRobots = 4'096;
/// Returns the first kMostRobots robots with the first kMostSensors sensors of each, in the order
/// of their names.
std::set<std::string> WithinBounds(const std::set<std::string>& all);
/// Returns "robot.sensor" for the subject of a LiDAR stream, or an empty text for other subjects.
std::string RobotOf(const FleetSettings& settings, const std::string& subject);

}  // namespace lidar::worker
