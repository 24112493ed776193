// SPDX-License-Identifier: LGPL-2.1-or-later
// Books of a fleet whose parts are killed: what became of each slice that a robot sent.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace lidar::test {

/// Times are seconds of one clock of the machine.
struct SentSlice {
  std::uint32_t scan = 0;
  std::uint32_t index = 0;
  double at = 0;
  std::size_t hash = 0;  // of its bytes

  std::tuple<std::uint32_t, std::uint32_t> place() const { return {scan, index}; }
};

/// A slice as JetStream has it at the end. `run` and `number` come from natssink.
struct StoredSlice {
  std::uint32_t scan = 0;
  std::uint32_t index = 0;
  double at = 0;
  std::size_t hash = 0;
  std::uint64_t run = 0;
  std::uint64_t number = 0;

  std::tuple<std::uint32_t, std::uint32_t> place() const { return {scan, index}; }
};

/// The time from when lidar-edge was up until it was killed.
struct EdgeLife {
  double up = 0;
  std::optional<double> killed;
};

/// The last report of lidar-edge on a session of one robot.
struct SessionReport {
  std::size_t life = 0;
  double receiving_from = std::numeric_limits<double>::infinity();
  double at = 0;
  std::uint64_t received = 0;      // by rtplidardepay
  std::uint64_t lost = 0;          // counted by rtplidardepay: lost, damaged, without a config
  std::uint64_t dropped = 0;       // counted by natssink
  std::uint64_t waiting = 0;       // in natssink
  std::uint64_t acknowledged = 0;  // by JetStream
};

/// Missing slices, by the part that has counted them.
struct Missing {
  std::uint64_t on_path = 0;  // rtplidardepay: the network, and what SCReAM gives up
  std::uint64_t by_sink = 0;  // natssink
  std::uint64_t at_kill = 0;  // lost in the edge, unacknowledged or not yet reported
  std::uint64_t away = 0;     // sent from when the edge was killed until it received again
  std::uint64_t not_counted = 0;

  std::uint64_t all() const { return on_path + by_sink + at_kill + away + not_counted; }
  Missing& operator+=(const Missing& o);
};

struct RobotBooks {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;      // by the last report of each session
  std::uint64_t acknowledged = 0;  // by the last report of each session
  std::uint64_t stored = 0;        // number of slices
  std::uint64_t twice = 0;         // number of messages that repeat a slice
  std::uint64_t strange = 0;       // number of messages that no robot sent
  std::uint64_t acknowledged_and_gone = 0;
  Missing missing;
  std::vector<std::string> gaps;  // a line for each

  RobotBooks& operator+=(const RobotBooks& o);
  /// Returns true if no acknowledged slice was lost, and each loss was counted.
  bool Balanced() const { return acknowledged_and_gone + missing.not_counted + strange == 0; }
};

/// `sent`, `sessions` and `lives` are in the order of time, `stored` in that of the stream. Slices
/// sent later than `report_age` before a killed edge's last report count as lost with the edge.
RobotBooks MakeBooks(const std::vector<SentSlice>& sent, const std::vector<StoredSlice>& stored,
                     const std::vector<SessionReport>& sessions, const std::vector<EdgeLife>& lives,
                     double report_age);

std::string TitleOfBooks();
std::string LineOfBooks(const std::string& robot, const RobotBooks& books);

}  // namespace lidar::test
