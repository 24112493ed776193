// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/transform_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "src/cloud/point_filter.h"

namespace lidar {
namespace {

using Quaternion = std::array<double, 4>;
using Position = std::array<double, 3>;

/// The tolerance for the length of a unit quaternion, as in tf2.
constexpr double kUnitTolerance = 0.01;
/// Farther positions are invalid, because no robot is as far as the moon. The limit keeps sums
/// finite [m].
constexpr double kFarthest = 1e9;
/// The greatest depth of the tree. A longer path is assumed to be a cycle.
constexpr std::size_t kMaxDepth = 64;
/// If the cosine between two orientations is above this limit, they are interpolated linearly.
constexpr double kNearlyParallel = 0.9995;

/// Removes a leading slash, which frame names in ROS 1 have.
void DropSlash(std::string* frame) {
  if (!frame->empty() && frame->front() == '/') frame->erase(0, 1);
}

double Dot(const Quaternion& a, const Quaternion& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

Quaternion Normalised(Quaternion q) {
  const double length = std::sqrt(Dot(q, q));
  for (double& v : q) v /= length;
  return q;
}

/// Composes two rotations: applies b first, then a.
Quaternion Times(const Quaternion& a, const Quaternion& b) {
  const auto& [ax, ay, az, aw] = a;
  const auto& [bx, by, bz, bw] = b;
  return {aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
          aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz};
}

Quaternion Inverse(const Quaternion& q) { return {-q[0], -q[1], -q[2], q[3]}; }

Position Turned(const Quaternion& q, const Position& p) {
  const Quaternion turned = Times(Times(q, {p[0], p[1], p[2], 0}), Inverse(q));
  return {turned[0], turned[1], turned[2]};
}

/// Composes two poses: applies b first, then a.
FramePose Times(const FramePose& a, const FramePose& b) {
  FramePose out;
  out.orientation = Normalised(Times(a.orientation, b.orientation));
  out.position = Turned(a.orientation, b.position);
  for (std::size_t i = 0; i < 3; ++i) out.position[i] += a.position[i];
  return out;
}

FramePose Inverse(const FramePose& pose) {
  FramePose out;
  out.orientation = Inverse(pose.orientation);
  out.position = Turned(out.orientation, pose.position);
  for (double& v : out.position) v = -v;
  return out;
}

/// Interpolates between two poses: returns a if `part` is 0, and b if `part` is 1. Rotates by the
/// shorter of the two possible rotations.
FramePose Between(const FramePose& a, const FramePose& b, double part) {
  FramePose out;
  for (std::size_t i = 0; i < 3; ++i)
    out.position[i] = a.position[i] + part * (b.position[i] - a.position[i]);
  const double cosine = Dot(a.orientation, b.orientation);
  const double angle = std::acos(std::min(std::abs(cosine), 1.0));
  const bool near = std::abs(cosine) > kNearlyParallel;
  const double from = near ? 1 - part : std::sin((1 - part) * angle) / std::sin(angle);
  const double to = near ? part : std::sin(part * angle) / std::sin(angle);
  for (std::size_t i = 0; i < 4; ++i)
    out.orientation[i] = from * a.orientation[i] + std::copysign(to, cosine) * b.orientation[i];
  out.orientation = Normalised(out.orientation);
  return out;
}

bool IsPose(const FramePose& pose) {
  const auto near = [](double v) { return std::abs(v) < kFarthest; };  // false for NaN
  return std::all_of(pose.position.begin(), pose.position.end(), near) &&
         std::abs(Dot(pose.orientation, pose.orientation) - 1) < kUnitTolerance;  // false for NaN
}

std::string ToText(Duration d) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f s", Seconds(d));
  return text;
}

}  // namespace

bool TransformTree::Set(std::string parent, std::string child, Time at, const FramePose& pose,
                        bool for_good) {
  DropSlash(&parent);
  DropSlash(&child);
  if (parent.empty() || child.empty() || parent == child || !IsPose(pose)) return false;
  if (links_.size() >= kMaxFrames && links_.count(child) == 0) return false;
  const Sample sample{at, {pose.position, Normalised(pose.orientation)}};
  Link& link = links_[child];
  if (link.for_good != for_good) link = {};
  link.for_good = for_good;
  if (for_good) link.history = {};
  if (!link.IsTooOld(at)) {
    link.earlier = {};
    link.too_old = 0;
    link.history.Add(parent, sample);
    return true;
  }
  link.earlier.Add(parent, sample);
  // too_old also counts poses that `earlier` has dropped because they were far from its newest
  // pose.
  if (++link.too_old < kRestart) return false;
  link.history = std::exchange(link.earlier, {});
  link.too_old = 0;
  return true;
}

bool TransformTree::Link::IsTooOld(Time at) const {
  return !history.samples.empty() && history.samples.back().at - at > kHistory;
}

/// Adds a pose. A frame has only one parent, so a pose in another parent clears the history.
void TransformTree::History::Add(const std::string& of, const Sample& sample) {
  if (parent != of) *this = {of, {}};
  const auto place = std::lower_bound(samples.begin(), samples.end(), sample.at,
                                      [](const Sample& s, Time time) { return s.at < time; });
  if (place != samples.end() && place->at == sample.at)
    *place = sample;
  else
    samples.insert(place, sample);
  while (samples.size() > kMaxSamples || samples.back().at - samples.front().at > kHistory)
    samples.pop_front();
}

bool TransformTree::Knows(const std::string& frame) const {
  return links_.count(frame) > 0 ||
         std::any_of(links_.begin(), links_.end(),
                     [&](const auto& entry) { return entry.second.history.parent == frame; });
}

/// Returns the frame, its parent, the parent's parent, and so on.
std::vector<std::string> TransformTree::PathUp(const std::string& frame) const {
  std::vector<std::string> path = {frame};
  auto link = links_.find(frame);
  for (; link != links_.end() && path.size() < kMaxDepth; link = links_.find(path.back()))
    path.push_back(link->second.history.parent);
  return path;
}

/// Returns the pose that converts points from the first frame of `path` to the frame `steps` above
/// it.
std::optional<FramePose> TransformTree::Climb(const std::vector<std::string>& path,
                                              std::size_t steps, std::optional<Time> at,
                                              Answer* answer) const {
  FramePose pose;
  for (std::size_t i = 0; i < steps; ++i) {
    const Link& link = links_.at(path[i]);
    const auto& [parent, samples] = link.history;
    if (link.for_good || !at) {
      pose = Times(samples.back().pose, pose);
      continue;
    }
    const std::string from_to = "from " + path[i] + " to " + parent;
    if (*at > samples.back().at) {
      answer->newest = samples.back().at;
      answer->may_come = true;
      answer->why = "the newest transform " + from_to + " is " + ToText(*at - answer->newest) +
                    " older than the cloud";
      return std::nullopt;
    }
    if (*at < samples.front().at) {
      answer->why = "the cloud is " + ToText(samples.front().at - *at) +
                    " older than the oldest transform " + from_to;
      return std::nullopt;
    }
    const auto after = std::lower_bound(samples.begin(), samples.end(), *at,
                                        [](const Sample& s, Time time) { return s.at < time; });
    FramePose here = after->pose;
    if (after->at != *at) {
      const Sample& before = *std::prev(after);
      here = Between(before.pose, after->pose,
                     Seconds(*at - before.at) / Seconds(after->at - before.at));
    }
    pose = Times(here, pose);
  }
  return pose;
}

TransformTree::Answer TransformTree::Find(const std::string& target, const std::string& source,
                                          std::optional<Time> at) const {
  std::string to = target;
  std::string from = source;
  DropSlash(&to);
  DropSlash(&from);
  Answer answer;
  const auto up_from = PathUp(from);
  const auto up_to = PathUp(to);
  auto meet = up_to.end();
  const auto common = std::find_if(up_from.begin(), up_from.end(), [&](const std::string& frame) {
    meet = std::find(up_to.begin(), up_to.end(), frame);
    return meet != up_to.end();
  });
  if (common == up_from.end()) {
    answer.may_come = true;
    for (const std::string& frame : {from, to})
      if (!Knows(frame)) answer.why = "no transform names the frame " + frame;
    if (answer.why.empty()) answer.why = "no transforms connect " + from + " with " + to;
    return answer;
  }
  const auto steps = [](auto begin, auto end) { return static_cast<std::size_t>(end - begin); };
  const auto there = Climb(up_from, steps(up_from.begin(), common), at, &answer);
  if (!there) return answer;
  const auto target_there = Climb(up_to, steps(up_to.begin(), meet), at, &answer);
  if (!target_there) return answer;
  const FramePose pose = Times(Inverse(*target_there), *there);
  answer.transform = FromPose(pose.position, pose.orientation);
  return answer;
}

}  // namespace lidar
