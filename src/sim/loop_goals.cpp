// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/loop_goals.h"

#include <cstdio>

namespace lidar::loop {
namespace {

constexpr double kCompleteOverDrives = 0.97;  // relative to the oracle's count
constexpr double kCompleteOverGaps = 0.98;
constexpr double kLatencyOverOracle_ms = 40;
constexpr double kUtilisation = 0.70;
constexpr double kRecovery_s = 0.3;
constexpr double kFramesUtilisation = 0.80;
// The late sender (see SendLate()) has a queue of 94 ms on a link with frequent gaps.
constexpr double kFramesQueueFrequentGaps_ms = 99;
constexpr double kFramesQueueLongGaps_ms = 15;
constexpr double kFramesQueue_ms = 6;

GoalResult AtLeast(const char* what, double value, double wanted) {
  char text[120];
  std::snprintf(text, sizeof text, what, value, wanted);
  return {text, value >= wanted};
}

GoalResult AtMost(const char* what, double value, double wanted) {
  char text[120];
  std::snprintf(text, sizeof text, what, value, wanted);
  return {text, value <= wanted};
}

bool Contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

double FramesQueueGoal(const std::string& name) {
  if (Contains(name, "every_0.6s")) return kFramesQueueFrequentGaps_ms;
  return Contains(name, "gaps_2") ? kFramesQueueLongGaps_ms : kFramesQueue_ms;
}

}  // namespace

LoopGoals GoalsOf(const LoopCase& c) {
  LoopGoals goals;
  if (Contains(c.name, "gap_")) {
    goals.of_oracle = 100 * kCompleteOverGaps;
    goals.back_s = kRecovery_s;
    return goals;
  }
  goals.of_oracle = 100 * kCompleteOverDrives;
  goals.utilisation = 100 * kUtilisation;
  goals.latency_over_oracle_ms = kLatencyOverOracle_ms;
  return goals;
}

std::vector<GoalResult> CheckGoals(const LoopCase& c, const LoopReport& r) {
  std::vector<GoalResult> goals;
  if (c.frames) {
    goals.push_back(
        AtLeast("utilisation %.1f %%, %.0f wanted", 100 * r.utilisation, 100 * kFramesUtilisation));
    goals.push_back(
        AtMost("queue p95 %.1f ms, %.0f wanted", r.queue_ms.p95, FramesQueueGoal(c.name)));
    return goals;
  }
  if (!c.source.adapts) return goals;
  const bool regular = Contains(c.name, "gap_");
  goals.push_back(AtLeast("complete %.1f %% of the oracle's, %.0f wanted", 100 * r.OfOracle(),
                          100 * (regular ? kCompleteOverGaps : kCompleteOverDrives)));
  if (regular) {
    goals.push_back(AtMost("back %.2f s after a gap, %.1f wanted", r.recovery_s.max, kRecovery_s));
    return goals;
  }
  goals.push_back(AtMost("capture to cloud p95 %.1f ms, %.1f wanted", r.capture_to_cloud_ms.p95,
                         r.oracle_at_mean.Latency(95) + kLatencyOverOracle_ms));
  goals.push_back(
      AtLeast("utilisation %.1f %%, %.0f wanted", 100 * r.utilisation, 100 * kUtilisation));
  return goals;
}

GoalResult CheckAgainstFixed(const LoopReport& r, const LoopReport& fixed) {
  char text[120];
  std::snprintf(text, sizeof text, "complete %d, of these %d in time; a fixed step: %d, %d",
                static_cast<int>(r.complete), static_cast<int>(r.in_time),
                static_cast<int>(fixed.complete), static_cast<int>(fixed.in_time));
  return {text, r.complete >= fixed.complete};
}

}  // namespace lidar::loop
