// SPDX-License-Identifier: LGPL-2.1-or-later
// What the key-value store says of a robot: who works for it, and how far that is.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "src/base/time.h"

namespace lidar::worker {

/// How far the work on a robot's stream is.
struct Progress {
  std::array<double, 7> pose{};  // x y z qx qy qz qw
  /// vx vy vz wx wy wz in the sensor's frame [m/s, rad/s], where it is known.
  std::optional<std::array<double, 6>> velocity;
  std::uint64_t time = 0;    // of the pose, by the robot's clock [ns]
  std::uint64_t stream = 0;  // when it was made [ns since 1970]: numbers are its own
  std::uint64_t scan = 0;    // number in the stream of the first message of the pose's scan
  std::uint64_t from = 0;    // of a message before it, from which on a decoder knows enough
};

struct LeaseRecord {
  std::string worker;  // empty: nobody
  Duration lease{};    // how long it holds from when it was written
  std::optional<Progress> progress;
};

/// False for what ParseLeaseRecord() would call damaged.
bool ReadsBack(const Progress& progress);

/// Velocity by the poses and times of two scans in a row; none where they are no such.
std::optional<std::array<double, 6>> VelocityBetween(const Progress& before, const Progress& after);

std::string ToJson(const LeaseRecord& record);
/// Returns nothing for what is damaged. Anything may come. An empty text is a record that says
/// nothing, as is that of a deleted key.
std::optional<LeaseRecord> ParseLeaseRecord(std::string_view text);

}  // namespace lidar::worker
