// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/figures.h"

#include <cmath>

namespace lidar::scream::test {
namespace {

constexpr FigureKind kUtilisation{"utilisation [%]", true, 1, 0};
constexpr FigureKind kQueueP95{"queue p95 [ms]", false, 0.5, 0.2};
constexpr FigureKind kQueueP99{"queue p99 [ms]", false, 0.5, 0.2};
constexpr FigureKind kQueueMax{"queue max [ms]", false, 2, 0.2};
constexpr FigureKind kFrameP95{"frame p95 [ms]", false, 1, 0.1};
constexpr FigureKind kFrameP99{"frame p99 [ms]", false, 1, 0.1};
constexpr FigureKind kOwnLoss{"own loss [%]", false, 0.1, 0.2};
constexpr FigureKind kJain{"Jain's index", true, 0.02, 0};
constexpr FigureKind kStartQueue{"queue of the start [ms]", false, 2, 0.2};
constexpr FigureKind kStartTime{"start [s]", false, 0.2, 0.1};
constexpr FigureKind kDropPeak{"drop: peak [ms]", false, 5, 0.1};
constexpr FigureKind kDropRecovered{"drop: below 10 ms [s]", false, 0.05, 0.1};
constexpr FigureKind kDropRate{"drop: rate below [s]", false, 0.03, 0.1};
constexpr FigureKind kRatio{"larger over smaller share", false, 0.1, 0.1};
constexpr FigureKind kOurs{"ours [Mbit/s]", true, 0.2, 0.05};
constexpr FigureKind kTheirs{"theirs [Mbit/s]", true, 0.2, 0.05};
constexpr FigureKind kTheirLoss{"their loss [%]", false, 0.1, 0.2};
constexpr FigureKind kRate{"media [Mbit/s]", true, 0.02, 0.03};
constexpr FigureKind kVariation{"variation of the rate", false, 0.03, 0.2};
constexpr FigureKind kOthers{"others [Mbit/s]", true, 0.02, 0.1};
constexpr FigureKind kFile{"a file of theirs [s]", false, 0.2, 0.1};
constexpr FigureKind kFeedback{"feedback over media [%]", false, 0.2, 0.2};
constexpr FigureKind kDropped{"frames dropped [%]", false, 0.2, 0.2};
constexpr FigureKind kDroppedFrames{"frames dropped", false, 3, 0.2};
constexpr FigureKind kStreams{"two streams' ratio", true, 0.1, 0.05};

/// The limits for the figures of `scenarios`. A limit below 0 is not checked.
struct MatrixGoal {
  std::vector<const char*> scenarios;
  double utilisation = -1;
  double queue_p95 = -1, queue_p99 = -1, queue_max = -1;
  double frame_p95 = -1, frame_p99 = -1;
  double own_loss = -1;
  double jain = -1;
  double ratio = -1;
};

MatrixGoal OnALink(std::vector<const char*> scenarios, double utilisation, double queue_p99 = 5,
                   double queue_max = 10, double frame_p95 = 35) {
  return {std::move(scenarios), utilisation, 5, queue_p99, queue_max, frame_p95, -1, 0, 0.99};
}
MatrixGoal OnSteps(const char* scenario, double utilisation, double frame_p95, double frame_p99) {
  return {{scenario}, utilisation, 10, 45, 140, frame_p95, frame_p99, 0, 0.99};
}
MatrixGoal Sharing(std::vector<const char*> scenarios, double jain) {
  MatrixGoal goal{std::move(scenarios)};
  goal.jain = jain;
  return goal;
}

const std::vector<MatrixGoal>& MatrixGoals() {
  static const std::vector<MatrixGoal> goals = [] {
    std::vector<MatrixGoal> all = {
        OnALink({"frames_20M_rtt25"}, 98, 4),
        OnALink({"slices_20M_rtt25"}, 96, 5, 15, 30),
        OnALink({"frames_8M_rtt40"}, 98, 5, 10, 45),
        OnALink({"frames10_8M_rtt40"}, 80, 8, 15, 110),
        OnALink({"slices_8M_rtt40"}, 96, 5, 15, 40),
        {{"frames_8M_fifo100_notect", "slices_8M_fifo100_notect"}, 95, 32, 40, 60, 70, -1, 0, 0.99},
        OnSteps("frames_steps_rtt40", 85, 50, 85),
        OnSteps("frames10_steps_rtt40", 72, 130, 145),
        OnSteps("slices_steps_rtt40", 90.7, 50, 58),
        OnALink({"frames_20M_loss0.5", "frames_20M_loss1.0"}, 92),
        OnALink({"frames_20M_loss2.0"}, 90),
        OnALink({"frames_20M_two_flows"}, 85, 5, 10, 40),
        {{"frames_8M_fifo10_notect", "slices_8M_fifo10_notect"}, 80, 10, 10, 12, 60, -1, 1, 0.99},
        {{"frames_8M_step1ms", "frames_20M_dualpi2"}, 94, -1, 3},
        {{"slices_8M_step1ms", "slices_20M_dualpi2"}, 92, -1, 3},
        {{"event_policer", "event_policer_lifted"}, 70, -1, -1, -1, -1, -1, 1},
        {{"event_silence", "event_silence_slower"}, 70, -1, -1, 60},
        {{"event_clock_back", "event_clock_ahead"}, 70, -1, -1, 30},
        Sharing({"prague_ramp_4M"}, 0.95),
        Sharing({"prague_ramp_8M", "prague_ramp_20M", "prague_dualpi2_20M"}, 0.97),
        Sharing({"prague_step_1ms_20M", "prague_step_3ms_20M"}, 0.95),
        Sharing({"two_flows_phase_4ms", "two_flows_phase_7ms", "two_flows_phase_10ms"}, 0.99),
    };
    MatrixGoal draft = Sharing({"draft_ramp_20M_phase_0ms", "draft_ramp_20M_phase_4ms",
                                "draft_ramp_20M_phase_7ms", "draft_ramp_20M_phase_13ms"},
                               0.92);
    draft.utilisation = 90;
    all.push_back(draft);
    MatrixGoal classic{{"cubic_fifo_15ms_8M", "cubic_fifo_5ms_20M", "cubic_fifo_10ms_20M",
                        "cubic_fifo_20ms_20M", "cubic_fifo_2ms_50M", "cubic_fifo_5ms_50M",
                        "cubic_fifo_10ms_50M", "reno_fifo_5ms_20M", "cubic_pi2_20M",
                        "cubic_dualpi2_20M"}};
    classic.ratio = 2.2;
    all.push_back(classic);
    return all;
  }();
  return goals;
}

const MatrixGoal* GoalOf(const std::string& scenario) {
  for (const MatrixGoal& goal : MatrixGoals())
    for (const char* name : goal.scenarios)
      if (scenario == name) return &goal;
  return nullptr;
}

std::optional<double> Limit(const MatrixGoal* goal, double MatrixGoal::*limit) {
  return goal != nullptr && goal->*limit >= 0 ? std::optional(goal->*limit) : std::nullopt;
}

/// Adds the figures of the start, and of a drop of the capacity.
void AddEvents(const Scenario& s, const ScenarioMetrics& m, std::vector<Figure>* figures) {
  if (s.drop_at) {
    figures->push_back({&kDropPeak, m.drop.peak_queue_ms, 150.0});
    figures->push_back({&kDropRecovered, m.drop.recovered_s, 0.35});
    figures->push_back({&kDropRate, m.drop.below_rate_s, 0.15});
  }
  if (s.name == "frames_20M_rtt25") {
    figures->push_back({&kStartTime, m.start_s, 1.5});
    figures->push_back({&kStartQueue, m.start_peak_ms, 30.0});
  }
}

}  // namespace

double Figure::BetterThan(const Figure& base) const {
  const double margin = base.kind->absolute + base.kind->relative * std::abs(base.value);
  const double gain = kind->more_is_better ? value - base.value : base.value - value;
  return gain / margin;
}

std::vector<Figure> Figures(const Scenario& s, const ScenarioMetrics& m) {
  const MatrixGoal* goal = GoalOf(s.name);
  std::vector<Figure> figures = {
      {&kUtilisation, 100 * m.utilisation, Limit(goal, &MatrixGoal::utilisation)},
      {&kQueueP95, m.queue_ms.p95, Limit(goal, &MatrixGoal::queue_p95)},
      {&kQueueP99, m.queue_ms.p99, Limit(goal, &MatrixGoal::queue_p99)},
      {&kQueueMax, m.queue_ms.max, Limit(goal, &MatrixGoal::queue_max)},
      {&kFrameP95, m.frame_ms.p95, Limit(goal, &MatrixGoal::frame_p95)},
      {&kFrameP99, m.frame_ms.p99, Limit(goal, &MatrixGoal::frame_p99)},
      {&kOwnLoss, 100 * m.own_loss, Limit(goal, &MatrixGoal::own_loss)},
      {&kJain, m.jain, Limit(goal, &MatrixGoal::jain)},
      {&kDroppedFrames, m.frames_dropped},
  };
  if (m.beside) {
    figures.push_back({&kRatio, m.beside->ratio(), Limit(goal, &MatrixGoal::ratio)});
    figures.push_back({&kOurs, m.beside->ours_mbps});
    figures.push_back({&kTheirs, m.beside->theirs_mbps});
    figures.push_back({&kTheirLoss, 100 * m.beside->their_loss});
  }
  AddEvents(s, m, &figures);
  return figures;
}

/// The goals are ours, because the RFCs define metrics but no limits.
std::vector<Figure> Figures(const RmcatCase& c, const RmcatMetrics& m) {
  const bool alone = c.config.others.empty();
  const auto goal = [&](double limit) { return alone ? std::optional(limit) : std::nullopt; };
  std::vector<Figure> figures = {
      {&kUtilisation, 100 * m.utilisation, goal(80)},
      {&kRate, m.media_mbps, 0.15},
      {&kVariation, m.variation},
      {&kQueueP95, m.queue_ms.p95, goal(100)},
      {&kQueueP99, m.queue_ms.p99},
      {&kFrameP95, m.frame_ms.p95},
      {&kOwnLoss, 100 * m.loss, 1.0},
      {&kDropped, 100 * m.dropped, goal(2)},
      {&kFeedback, 100 * m.feedback},
  };
  if (c.forward.size() > 1) figures.push_back({&kJain, m.jain, 0.9});
  if (!alone) figures.push_back({&kOthers, m.others_mbps});
  if (m.file_s > 0) figures.push_back({&kFile, m.file_s});
  if (m.stream_ratio) figures.push_back({&kStreams, *m.stream_ratio, 1.5});
  return figures;
}

std::vector<std::string> ScenariosWithGoals() {
  std::vector<std::string> names{"frames_drop_10M_to_3M", "slices_drop_10M_to_3M"};
  for (const MatrixGoal& goal : MatrixGoals())
    names.insert(names.end(), goal.scenarios.begin(), goal.scenarios.end());
  return names;
}

}  // namespace lidar::scream::test
