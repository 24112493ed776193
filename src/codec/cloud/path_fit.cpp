// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/path_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "src/codec/cloud/median.h"

namespace lidar::codec::cloud {
namespace {

/// A point that a laser measured.
struct Sample {
  std::uint32_t point = 0;
  std::uint32_t column = 0;
  double time = 0;
  double azimuth = 0;  // minus the azimuth of the turn, not wrapped
};
using Line = std::vector<Sample>;  // in the order of firing

/// Returns the points of each laser, sorted by time. Returns no lines if there are too many lasers
/// or too few points.
std::vector<Line> LinesOf(const std::vector<Pulse>& pulses) {
  constexpr std::size_t kLeastPoints = 64;
  std::vector<Line> lines;
  if (pulses.size() < kLeastPoints) return lines;
  for (std::uint32_t i = 0; i < pulses.size(); ++i) {
    const Pulse& pulse = pulses[i];
    if (pulse.line >= kMostPathBeams || !std::isfinite(pulse.time)) return {};
    if (pulse.line >= lines.size()) lines.resize(pulse.line + 1);
    lines[pulse.line].push_back({i, 0, pulse.time, 0});
  }
  const auto is_earlier = [](const Sample& a, const Sample& b) { return a.time < b.time; };
  for (Line& line : lines)
    if (!std::is_sorted(line.begin(), line.end(), is_earlier))
      std::stable_sort(line.begin(), line.end(), is_earlier);
  return lines;
}

/// Calls `call` with each pair of successive samples of a line.
template <class Call>
void ForPairs(const std::vector<Line>& lines, Call&& call) {
  for (const Line& line : lines)
    for (std::size_t i = 1; i < line.size(); ++i) call(line[i - 1], line[i]);
}

/// Returns the time from one column to the next, or 0 if it is unknown.
double PeriodOf(const std::vector<Line>& lines) {
  std::vector<double> steps;
  ForPairs(lines, [&](const Sample& a, const Sample& b) {
    if (b.time > a.time) steps.push_back(b.time - a.time);
  });
  double period = MedianOf(std::move(steps));
  // Long steps are used only in the second pass, when the period is more exact.
  for (const double longest : {8.0, 1e9}) {
    double time = 0;
    double columns = 0;
    ForPairs(lines, [&](const Sample& a, const Sample& b) {
      const double count = std::round((b.time - a.time) / period);
      if (!(count <= longest)) return;
      time += b.time - a.time;
      columns += count;
    });
    if (!(columns > 0)) return 0;
    period = time / columns;
  }
  return period;
}

/// Sets the columns of all samples. Returns the number of columns, or 0 if there are too many.
std::uint32_t CountColumns(std::vector<Line>* lines) {
  const double period = PeriodOf(*lines);
  if (!(period > 0)) return 0;
  double first = INFINITY;
  for (const Line& line : *lines)
    if (!line.empty()) first = std::min(first, line.front().time);
  double columns = 0;
  for (Line& line : *lines) {
    if (line.empty()) continue;
    // The lasers of a column fire one after the other, within the period of the column. A time may
    // be too early by up to an eighth of the period.
    const double start = std::floor((line.front().time - first) / period + 0.125);
    for (Sample& s : line) {
      const double column = start + std::round((s.time - line.front().time) / period);
      if (column >= BeamTable::kMostColumns) return 0;
      s.column = static_cast<std::uint32_t>(column);
      columns = std::max(columns, column + 1);
    }
  }
  return static_cast<std::uint32_t>(columns);
}

/// Sets the azimuth of each sample, minus the azimuth of the turn. Returns by how much these
/// azimuths rise from one column to the next, on average.
double Unwrap(const std::vector<Sighting>& points, const BeamPath& path, std::vector<Line>* lines) {
  double sum = 0;
  double squares = 0;
  for (Line& line : *lines) {
    std::int64_t last = 0;
    double mean = 0;
    double middle = 0;
    for (Sample& s : line) {
      const std::int64_t away = points[s.point].azimuth - path.TurnAt(s.column) - last;
      last += Wrapped(static_cast<std::int32_t>(away & (kTurn - 1)));
      s.azimuth = static_cast<double>(last);
      mean += s.azimuth;
      middle += s.column;
    }
    const auto count = static_cast<double>(line.size());
    for (const Sample& s : line) {
      const double away = s.column - middle / count;
      sum += away * (s.azimuth - mean / count);
      squares += away * away;
    }
  }
  return squares > 0 ? sum / squares : 0;
}

/// Returns the angle of the turn from one column to the next, in 1/2^kRateBits of an angle unit.
/// Returns 0 if there is no plausible turn.
std::int32_t RateOf(const std::vector<Sighting>& points, std::uint32_t columns,
                    std::vector<Line>* lines) {
  std::vector<double> steps;
  ForPairs(*lines, [&](const Sample& a, const Sample& b) {
    if (b.column == a.column + 1)
      steps.push_back(Wrapped(points[b.point].azimuth - points[a.point].azimuth));
  });
  constexpr double kScale = 1U << BeamPath::kRateBits;
  constexpr double kLeast = 64;  // many times the rounding of coordinates
  const auto in_steps = [](double rate) {
    return std::abs(rate) > kLeast && std::abs(rate) < kTurn / 16
               ? static_cast<std::int32_t>(std::lround(rate * kScale))
               : 0;
  };
  const double rate = MedianOf(std::move(steps));
  const BeamPath rough(in_steps(rate), columns);
  return in_steps(rate + Unwrap(points, rough, lines));
}

/// Fits the two curves of a beam by least squares.
class CurveFit {
 public:
  void Add(const BeamPath::Terms& terms, double azimuth, double elevation) {
    for (std::size_t i = 0; i < kPathTerms; ++i) {
      for (std::size_t k = 0; k <= i; ++k) products_[i][k] += terms[i] * terms[k];
      azimuths_[i] += terms[i] * azimuth;
      elevations_[i] += terms[i] * elevation;
    }
    count_ += 1;
  }
  /// Returns the curves, or nothing if a factor is too large for the format.
  std::optional<PathBeam> Solve() {
    // The stiffness keeps factors small where columns have no points, because large factors need
    // more bits.
    for (std::size_t i = 0; i < kPathTerms; ++i) products_[i][i] += kStiffness * (count_ + 1);
    Factorise();
    PathBeam beam;
    if (!Solve(azimuths_, &beam.azimuth) || !Solve(elevations_, &beam.elevation))
      return std::nullopt;
    return beam;
  }

 private:
  static constexpr double kStiffness = 1e-8;

  /// Replaces the matrix of products by its Cholesky factor.
  void Factorise() {
    for (std::size_t i = 0; i < kPathTerms; ++i)
      for (std::size_t k = 0; k <= i; ++k) {
        double sum = products_[i][k];
        for (std::size_t m = 0; m < k; ++m) sum -= products_[i][m] * products_[k][m];
        products_[i][k] = i == k ? std::sqrt(std::max(sum, 1e-12)) : sum / products_[k][k];
      }
  }
  bool Solve(BeamPath::Terms sums, PathCurve* curve) const {
    for (std::size_t i = 0; i < kPathTerms; ++i) {
      for (std::size_t k = 0; k < i; ++k) sums[i] -= products_[i][k] * sums[k];
      sums[i] /= products_[i][i];
    }
    for (std::size_t i = kPathTerms; i-- > 0;) {
      for (std::size_t k = i + 1; k < kPathTerms; ++k) sums[i] -= products_[k][i] * sums[k];
      sums[i] /= products_[i][i];
      const double factor = std::round(sums[i] / kPathUnit);
      if (!(std::abs(factor) <= kTurn / kPathUnit)) return false;
      (*curve)[i] = static_cast<std::int32_t>(factor);
    }
    return true;
  }

  std::array<BeamPath::Terms, kPathTerms> products_{};
  BeamPath::Terms azimuths_{};
  BeamPath::Terms elevations_{};
  double count_ = 0;
};

double ElevationOf(const Sighting& s) { return std::atan2(s.z_m, s.rho_m) / kRadians; }

std::optional<PathBeam> FitLine(const std::vector<Sighting>& points, const BeamPath& path,
                                const Line& line) {
  constexpr std::size_t kMostSamples = 128;
  CurveFit fit;
  const std::size_t stride = line.size() / kMostSamples + 1;
  for (std::size_t i = 0; i < line.size(); i += stride) {
    const Sample& s = line[i];
    fit.Add(path.TermsAt(s.column), s.azimuth, ElevationOf(points[s.point]));
  }
  return fit.Solve();
}

}  // namespace

std::optional<BeamTable> FindPath(const std::vector<Sighting>& points,
                                  const std::vector<Pulse>& pulses,
                                  std::vector<PlacedPoint>* placed) {
  std::vector<Line> lines = LinesOf(pulses);
  const std::uint32_t columns = CountColumns(&lines);
  if (columns < 2) return std::nullopt;
  BeamTable table;
  table.turn = columns * BeamTable::kParts;
  table.rate = RateOf(points, columns, &lines);
  if (!table.has_path()) return std::nullopt;
  const BeamPath path(table.rate, columns);
  Unwrap(points, path, &lines);
  for (const Line& line : lines) {
    const auto beam = FitLine(points, path, line);
    if (!beam) return std::nullopt;
    table.path.push_back(*beam);
  }
  table.beams.resize(lines.size());
  const std::vector<PathDirection> directions = path.Trace(table.path, 0, columns);
  placed->assign(points.size(), {});
  for (std::uint32_t beam = 0; beam < lines.size(); ++beam)
    for (const Sample& s : lines[beam]) {
      const PathDirection& at = directions[std::size_t{beam} * columns + s.column];
      PlacedPoint& p = (*placed)[s.point];
      p.beam = beam;
      p.column = s.column;
      p.along_m = points[s.point].range_m;
      p.residual = Wrapped(points[s.point].azimuth - at.azimuth);
      const double bend = ElevationOf(points[s.point]) - at.elevation;
      p.bend = static_cast<std::int32_t>(std::lround(bend));
      p.above_m = bend * kRadians * p.along_m;
    }
  return table;
}

}  // namespace lidar::codec::cloud
