// SPDX-License-Identifier: LGPL-2.1-or-later
// A robot's entry in the key-value store. It names the worker that has the robot, and holds the
// progress of that worker.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "src/base/time.h"

namespace lidar::worker {

/// The last pose that a worker has computed for a robot, and its position in the robot's stream.
struct Progress {
  std::array<double, 7> pose{};  // x y z qx qy qz qw
  /// The velocity vx vy vz wx wy wz in the sensor's frame [m/s, rad/s], if known.
  std::optional<std::array<double, 6>> velocity;
  std::uint64_t time = 0;  // time of the pose by the robot's clock [ns]
  // The creation time of the stream to which the message numbers belong [ns since 1970].
  std::uint64_t stream = 0;
  std::uint64_t scan = 0;  // number of the first message of the pose's scan
  std::uint64_t from = 0;  // number of an earlier message, from which a decoder can start
};

struct LeaseRecord {
  std::string worker;  // empty: no worker
  Duration lease{};    // duration of the lease, from the time at which the record is written
  std::optional<Progress> progress;
};

/// Returns true if ParseLeaseRecord() would accept a record with this progress.
bool ReadsBack(const Progress& progress);

/// Returns the velocity between two consecutive scans. Returns nothing if their times are too close
/// or too far apart, or if the velocity is implausible.
std::optional<std::array<double, 6>> VelocityBetween(const Progress& before, const Progress& after);

std::string ToJson(const LeaseRecord& record);
/// Parses untrusted text. Returns nothing if the text is damaged. Returns an empty record for an
/// empty text, because the entry of a deleted key has no text.
std::optional<LeaseRecord> ParseLeaseRecord(std::string_view text);

}  // namespace lidar::worker
