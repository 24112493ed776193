// SPDX-License-Identifier: LGPL-2.1-or-later
// Books of a fleet whose parts are killed. The books tell what happened to each slice that a robot
// sent.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace lidar::test {

/// A slice that a robot sent. All times in this file are in seconds, by one clock of the machine.
struct SentSlice {
  std::uint32_t scan = 0;
  std::uint32_t index = 0;
  double at = 0;
  std::size_t hash = 0;  // of the slice's bytes

  std::tuple<std::uint32_t, std::uint32_t> place() const { return {scan, index}; }
};

/// A slice that is in the JetStream stream at the end. natssink wrote `run` and `number`.
struct StoredSlice {
  std::uint32_t scan = 0;
  std::uint32_t index = 0;
  double at = 0;
  std::size_t hash = 0;
  std::uint64_t run = 0;
  std::uint64_t number = 0;

  std::tuple<std::uint32_t, std::uint32_t> place() const { return {scan, index}; }
};

/// The time from the start of a lidar-edge process until it was killed.
struct EdgeLife {
  double up = 0;
  std::optional<double> killed;
};

/// The last report that lidar-edge made about a session of one robot.
struct SessionReport {
  std::size_t life = 0;
  double receiving_from = std::numeric_limits<double>::infinity();
  double at = 0;
  std::uint64_t received = 0;  // number of slices that rtplidardepay received
  // Number of slices that rtplidardepay counted as lost, as damaged, or as without a config.
  std::uint64_t lost = 0;
  std::uint64_t dropped = 0;       // slices that natssink dropped
  std::uint64_t waiting = 0;       // slices that wait in natssink
  std::uint64_t acknowledged = 0;  // slices that JetStream acknowledged
};

/// The numbers of missing slices, by the part that counted them.
struct Missing {
  std::uint64_t on_path = 0;  // by rtplidardepay: lost by the network or dropped by SCReAM
  std::uint64_t by_sink = 0;  // by natssink
  std::uint64_t at_kill = 0;  // lost when the edge was killed: unacknowledged or not yet reported
  std::uint64_t away = 0;     // sent between the kill of the edge and its next reception
  std::uint64_t not_counted = 0;

  std::uint64_t all() const { return on_path + by_sink + at_kill + away + not_counted; }
  Missing& operator+=(const Missing& o);
};

struct RobotBooks {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;      // sum of the sessions' last reports
  std::uint64_t acknowledged = 0;  // sum of the sessions' last reports
  std::uint64_t stored = 0;        // number of stored slices
  std::uint64_t twice = 0;         // number of stored messages that repeat a slice
  std::uint64_t strange = 0;       // number of stored messages that no robot sent
  std::uint64_t acknowledged_and_gone = 0;
  Missing missing;
  std::vector<std::string> gaps;  // one line for each gap

  RobotBooks& operator+=(const RobotBooks& o);
  /// Returns true if no acknowledged slice was lost and a part counted each loss.
  bool Balanced() const { return acknowledged_and_gone + missing.not_counted + strange == 0; }
};

/// Makes the books of one robot. `sent`, `sessions` and `lives` are sorted by time, `stored` is in
/// the order of the stream. If an edge was killed, slices that were sent later than `report_age`
/// before its last report count as lost with the edge.
RobotBooks MakeBooks(const std::vector<SentSlice>& sent, const std::vector<StoredSlice>& stored,
                     const std::vector<SessionReport>& sessions, const std::vector<EdgeLife>& lives,
                     double report_age);

std::string TitleOfBooks();
std::string LineOfBooks(const std::string& robot, const RobotBooks& books);

}  // namespace lidar::test
