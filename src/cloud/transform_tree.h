// SPDX-License-Identifier: LGPL-2.1-or-later
// The transforms between frames over time, as ROS's tf2 keeps them.
#pragma once
#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "src/base/time.h"
#include "src/cloud/sensor_model.h"

namespace lidar {

/// Takes points of a child frame to its parent.
struct FramePose {
  std::array<double, 3> position{};                  // m
  std::array<double, 4> orientation = {0, 0, 0, 1};  // unit quaternion x, y, z, w
};

/// Frames, each below one parent, in bounded memory.
class TransformTree {
 public:
  static constexpr std::size_t kMaxFrames = 512;
  static constexpr std::size_t kMaxSamples = 2048;  // per frame
  static constexpr Duration kHistory = std::chrono::seconds(10);
  static constexpr std::size_t kRestart = 10;  // poses

  /// Sets the pose of `child` in `parent`, at a time or permanently. Returns false for an invalid
  /// pose, unnamed or equal frames, or too many frames. Like tf2, it refuses poses older than
  /// kHistory. kRestart such poses of a frame in a row show that the clock went back: they then
  /// replace the history, as far as it can hold them.
  bool Set(std::string parent, std::string child, Time at, const FramePose& pose, bool for_good);

  struct Answer {
    std::optional<Transform> transform;  // takes points of the source to the target
    std::string why;                     // why there is none, for a user
    bool may_come = false;               // a later pose may lead to a transform
    Time newest{};                       // of the newest pose, if a later pose is needed
  };
  /// Poses are interpolated between two times. Without a time the newest poses are used.
  Answer Find(const std::string& target, const std::string& source, std::optional<Time> at) const;

  std::size_t frames() const { return links_.size(); }

 private:
  struct Sample {
    Time at{};
    FramePose pose;
  };
  struct History {
    std::string parent;
    std::deque<Sample> samples;  // by time

    void Add(const std::string& of, const Sample& sample);
  };
  struct Link {
    bool for_good = false;
    History history;          // never empty
    History earlier;          // from a clock that may have gone back
    std::size_t too_old = 0;  // too old poses in a row

    bool IsTooOld(Time at) const;
  };

  bool Knows(const std::string& frame) const;
  std::vector<std::string> PathUp(const std::string& frame) const;
  std::optional<FramePose> Climb(const std::vector<std::string>& path, std::size_t steps,
                                 std::optional<Time> at, Answer* answer) const;

  std::unordered_map<std::string, Link> links_;  // by child
};

}  // namespace lidar
