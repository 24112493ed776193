// SPDX-License-Identifier: LGPL-2.1-or-later
// A robot's entry in the key-value store: its worker, and the worker's progress.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "src/base/time.h"

namespace lidar::worker {

/// Progress of the work on a robot's stream.
struct Progress {
  std::array<double, 7> pose{};  // x y z qx qy qz qw
  /// vx vy vz wx wy wz in the sensor's frame [m/s, rad/s], if known.
  std::optional<std::array<double, 6>> velocity;
  std::uint64_t time = 0;    // of the pose, by the robot's clock [ns]
  std::uint64_t stream = 0;  // creation of the stream [ns since 1970]; message numbers belong to it
  std::uint64_t scan = 0;    // number of the first message of the pose's scan
  std::uint64_t from = 0;    // an earlier message from which a decoder can start
};

struct LeaseRecord {
  std::string worker;  // empty: no worker
  Duration lease{};    // duration of the lease from the time of its write
  std::optional<Progress> progress;
};

/// Returns false if ParseLeaseRecord() would refuse it.
bool ReadsBack(const Progress& progress);

/// Returns the velocity between two consecutive scans; nothing if their times are too close or too
/// far apart.
std::optional<std::array<double, 6>> VelocityBetween(const Progress& before, const Progress& after);

std::string ToJson(const LeaseRecord& record);
/// Parses untrusted text; returns nothing if it is damaged. An empty text, as of a deleted key, is
/// an empty record.
std::optional<LeaseRecord> ParseLeaseRecord(std::string_view text);

}  // namespace lidar::worker
