// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "src/codec/cloud/even_firings.h"
#include "src/codec/cloud/wave_fit.h"

namespace lidar::codec::cloud {
namespace {

constexpr double kRateScale = 1U << BeamTable::kRateBits;
constexpr double kSwingScale = 1U << BeamTable::kSwingBits;

std::int32_t Rounded(double value) {
  constexpr double kMost = 1 << 28;  // beyond the format
  return static_cast<std::int32_t>(std::lround(std::clamp(value, -kMost, kMost)));
}

/// Returns the residuals of the swing.
std::vector<Sample> LeftOf(const std::vector<Sample>& samples, double angle) {
  const Wave swing = FitWave(SomeOf(samples, 2'048), angle);
  std::vector<Sample> left = samples;
  for (Sample& s : left) {
    const double phase = angle * s.firing;
    s.elevation -= swing.middle + swing.cosine * std::cos(phase) + swing.sine * std::sin(phase);
  }
  return left;
}

/// Sums of the samples of one of the beams that fire in turn.
struct LineSums {
  double mean() const { return count > 0 ? sum / count : 0; }
  double Spread() const { return squares - sum * mean(); }
  double count = 0;
  double sum = 0;
  double squares = 0;
};

std::vector<LineSums> SumLines(const std::vector<Sample>& samples, std::uint32_t lines) {
  std::vector<LineSums> sums(lines);
  for (const Sample& s : samples) {
    LineSums& line = sums[static_cast<std::uint32_t>(s.firing) % lines];
    line.count += 1;
    line.sum += s.elevation;
    line.squares += s.elevation * s.elevation;
  }
  return sums;
}

/// Returns how many beams fire in turn, from the residuals of the swing.
std::uint32_t CountLines(const std::vector<Sample>& left) {
  constexpr double kAlike = 2;
  std::array<double, kMostLines + 1> spreads{};
  for (std::uint32_t lines = 1; lines <= kMostLines; ++lines)
    for (const LineSums& line : SumLines(left, lines)) spreads[lines] += line.Spread();
  const double least = *std::min_element(spreads.begin() + 1, spreads.end());
  std::uint32_t lines = 1;
  while (lines < kMostLines && spreads[lines] > kAlike * least) ++lines;
  return lines;
}

/// Subtracts the elevation of its beam from each sample.
std::vector<Sample> Levelled(std::vector<Sample> samples, const std::vector<LineSums>& lines) {
  for (Sample& s : samples)
    s.elevation -= lines[static_cast<std::uint32_t>(s.firing) % lines.size()].mean();
  return samples;
}

/// Returns the table of `lines` beams that fire in turn. `beam_of` has the beam of each firing.
BeamTable TableOf(const EvenFirings& firings, std::uint32_t lines, double angle,
                  std::vector<std::uint32_t>* beam_of) {
  BeamTable table;
  table.turn = ((firings.count + lines - 1) / lines) * BeamTable::kParts;
  table.rate = Rounded(firings.step * lines * kRateScale);
  table.swing_rate =
      static_cast<std::uint32_t>(std::lround(angle * lines / 2 / M_PI * kSwingScale));
  const double of_column = 2 * M_PI * table.swing_rate / kSwingScale;
  std::vector<WaveSums> sums(lines);
  for (const Sample& s : firings.samples) {
    const auto firing = static_cast<std::uint32_t>(s.firing);
    const double phase = of_column * (firing / lines);
    sums[firing % lines].Add(std::cos(phase), std::sin(phase), s.elevation);
  }
  std::vector<std::pair<std::int32_t, std::uint32_t>> order;
  std::vector<BeamTable::Beam> beams(lines);
  for (std::uint32_t i = 0; i < lines; ++i) {
    const Wave swing = sums[i].Solve();
    beams[i].elevation = Rounded(swing.middle);
    beams[i].offset = Rounded(firings.first + firings.step * i) & (kTurn - 1);
    beams[i].rise = {Rounded(swing.cosine), Rounded(swing.sine)};
    order.emplace_back(-beams[i].elevation, i);
  }
  std::sort(order.begin(), order.end());
  beam_of->assign(lines, 0);
  for (const auto& [below, line] : order) {
    (*beam_of)[line] = table.rows();
    table.beams.push_back(beams[line]);
  }
  return table;
}

/// Returns true if all numbers fit the format.
bool CanBeWritten(const BeamTable& table) {
  return table.columns() <= BeamTable::kMostColumns &&
         std::abs(table.rate) <= BeamTable::kMostRate && table.swing_rate < kSwingScale &&
         std::all_of(table.beams.begin(), table.beams.end(), [](const BeamTable::Beam& b) {
           return std::max({std::abs(b.elevation), std::abs(b.rise[0]), std::abs(b.rise[1])}) <=
                  kTurn / 4;
         });
}

}  // namespace

std::optional<BeamTable> FindPath(const std::vector<Sighting>& points, const BeamTable* last,
                                  std::vector<PlacedPoint>* placed) {
  const auto firings = FindFirings(points);
  if (!firings) return std::nullopt;
  const std::vector<Sample>& samples = firings->samples;
  const std::uint32_t count = firings->count;
  const double rough = last != nullptr ? 2 * M_PI * last->swing_rate / kSwingScale / last->rows()
                                       : FineAngle(samples, count, CoarseAngle(samples, count));
  const std::vector<Sample> left = LeftOf(samples, rough);
  const std::uint32_t lines = last != nullptr ? last->rows() : CountLines(left);
  const double angle = FineAngle(Levelled(samples, SumLines(left, lines)), count, rough);
  std::vector<std::uint32_t> beam_of;
  BeamTable table = TableOf(*firings, lines, angle, &beam_of);
  if (!CanBeWritten(table)) return std::nullopt;
  placed->assign(points.size(), {});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto firing = static_cast<std::uint32_t>(samples[i].firing);
    PlacedPoint& p = (*placed)[i];
    p.beam = beam_of[firing % lines];
    p.column = firing / lines;
    p.along_m = points[i].range_m;
    p.above_m =
        (samples[i].elevation - table.ElevationOf(p.beam, p.column)) * kRadians * points[i].range_m;
    p.residual = Wrapped(points[i].azimuth - table.AzimuthOf(p.beam, p.column));
  }
  return table;
}

}  // namespace lidar::codec::cloud
