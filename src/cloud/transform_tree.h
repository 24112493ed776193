// SPDX-License-Identifier: LGPL-2.1-or-later
// Stores the transforms between frames over time, like tf2 in ROS.
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

/// The pose of a child frame in its parent frame. It converts points from the child to the parent.
struct FramePose {
  std::array<double, 3> position{};                  // m
  std::array<double, 4> orientation = {0, 0, 0, 1};  // unit quaternion x, y, z, w
};

/// A tree of frames, in which each frame has one parent. Its memory is bounded.
class TransformTree {
 public:
  static constexpr std::size_t kMaxFrames = 512;
  static constexpr std::size_t kMaxSamples = 2048;  // for each frame
  static constexpr Duration kHistory = std::chrono::seconds(10);
  static constexpr std::size_t kRestart = 10;  // number of poses

  /// Sets the pose of `child` in `parent`, at the time `at` or permanently. Returns false for an
  /// invalid pose, for empty or equal frame names, or for too many frames. Like tf2, it also
  /// refuses a pose that is more than kHistory older than the newest pose. But if kRestart of these
  /// poses arrive in a row, the clock was set back, and these poses replace the history.
  bool Set(std::string parent, std::string child, Time at, const FramePose& pose, bool for_good);

  struct Answer {
    std::optional<Transform> transform;  // converts points from the source to the target
    std::string why;                     // if there is no transform: the reason, for the user
    bool may_come = false;               // true if a later pose may complete the transform
    Time newest{};                       // time of the newest pose, if a later pose is needed
  };
  /// Returns the transform from `source` to `target` at the time `at`. Poses are interpolated
  /// between two times. If `at` is empty, the newest poses are used.
  Answer Find(const std::string& target, const std::string& source, std::optional<Time> at) const;

  std::size_t frames() const { return links_.size(); }

 private:
  struct Sample {
    Time at{};
    FramePose pose;
  };
  struct History {
    std::string parent;
    std::deque<Sample> samples;  // sorted by time

    void Add(const std::string& of, const Sample& sample);
  };
  struct Link {
    bool for_good = false;
    History history;          // never empty
    History earlier;          // poses that are too old, after which the clock may have gone back
    std::size_t too_old = 0;  // number of poses in a row that were too old

    bool IsTooOld(Time at) const;
  };

  bool Knows(const std::string& frame) const;
  std::vector<std::string> PathUp(const std::string& frame) const;
  std::optional<FramePose> Climb(const std::vector<std::string>& path, std::size_t steps,
                                 std::optional<Time> at, Answer* answer) const;

  std::unordered_map<std::string, Link> links_;  // by the name of the child
};

}  // namespace lidar
