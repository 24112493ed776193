// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/trace_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "src/link/random.h"

namespace lidar::link {
namespace {

constexpr Duration kStep = std::chrono::milliseconds{100};
constexpr double kGapsPerSecond = 0.28;
constexpr double kEdgesPerSecond = 1.0 / 30;
constexpr double kEdgeGapsPerSecond = 1.2;
constexpr double kEdgeShare = 0.35;  // rate at the edge of a cell, relative to elsewhere
constexpr double kShortestEdge_s = 2;
constexpr double kLongestEdge_s = 6;
constexpr double kRateCorrelation = 0.87;  // of the logarithm of the rate, from step to step
constexpr double kDeviation = 0.5;

struct GapLength {
  double probability;
  int shortest, longest;  // length in steps
};
constexpr std::array<GapLength, 4> kGapLengths = {
    {{0.5, 1, 1}, {0.25, 2, 3}, {0.17, 4, 6}, {0.08, 7, 20}}};

class Drive {
 public:
  explicit Drive(std::uint64_t seed) : random_(seed) {}

  /// Returns the rate of the next step, relative to the mean, or 0 in a gap.
  double Next() {
    fading_ = kRateCorrelation * fading_ +
              std::sqrt(1 - kRateCorrelation * kRateCorrelation) * kDeviation * Normal();
    if (edge_left_ > 0) --edge_left_;
    if (edge_left_ == 0 && random_.Chance(kEdgesPerSecond * Seconds(kStep)))
      edge_left_ = Steps(kShortestEdge_s + (kLongestEdge_s - kShortestEdge_s) * random_.Uniform());
    if (gap_left_ > 0) {
      --gap_left_;
    } else {
      const double gaps = edge_left_ > 0 ? kEdgeGapsPerSecond : kGapsPerSecond;
      if (random_.Chance(gaps * Seconds(kStep))) gap_left_ = GapSteps();
    }
    if (gap_left_ > 0) return 0;
    return std::exp(fading_) * (edge_left_ > 0 ? kEdgeShare : 1);
  }

 private:
  static int Steps(double seconds) { return static_cast<int>(seconds / Seconds(kStep)); }

  /// Returns a nearly Gaussian number, which is the same on every machine: the sum of twelve
  /// uniform numbers.
  double Normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += random_.Uniform();
    return sum;
  }

  int GapSteps() {
    double p = random_.Uniform();
    for (const GapLength& g : kGapLengths) {
      if (p < g.probability)
        return g.shortest + static_cast<int>((g.longest - g.shortest + 1) * random_.Uniform());
      p -= g.probability;
    }
    return 1;
  }

  Random random_;
  double fading_ = 0;
  int edge_left_ = 0;
  int gap_left_ = 0;
};

void AppendLine(Duration time, DataRate rate, std::string* text) {
  char line[64];
  std::snprintf(line, sizeof line, "%.14g %.7g\n", Seconds(time), rate.bits_per_second() / 1e6);
  *text += line;
}

}  // namespace

std::string MakeDriveTrace(const DriveTraceConfig& config) {
  Drive drive(config.seed);
  std::vector<double> rates;
  double sum = 0;
  for (Duration t{0}; t < config.duration; t += kStep) {
    rates.push_back(drive.Next());
    sum += rates.back();
  }
  const double scale = sum > 0 ? static_cast<double>(rates.size()) / sum : 0;
  std::string text =
      "# time_s rate_mbps; a drive with handover gaps, seed " + std::to_string(config.seed) + "\n";
  for (std::size_t i = 0; i < rates.size(); ++i)
    AppendLine(kStep * static_cast<std::int64_t>(i),
               std::max(config.in_gaps, config.mean * (scale * rates[i])), &text);
  return text;
}

std::string MakeGapTrace(const GapTraceConfig& config) {
  std::string text = "# time_s rate_mbps; regular gaps\n";
  Duration t{0};
  for (; t < config.duration; t += config.every) {
    AppendLine(t, config.rate, &text);
    AppendLine(t + config.every - config.gap, config.in_gaps, &text);
  }
  // The last line of a repeating trace lasts as long as the line before it. So two lines describe
  // the last gap, and each of them lasts half of the gap.
  AppendLine(t - config.gap / 2, config.in_gaps, &text);
  return text;
}

}  // namespace lidar::link
