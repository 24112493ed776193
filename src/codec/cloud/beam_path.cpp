// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lidar::codec::cloud {
namespace {

constexpr std::uint32_t kMostLines = 16;
constexpr double kRateScale = 1U << BeamTable::kRateBits;
constexpr double kSwingScale = 1U << BeamTable::kSwingBits;

std::int32_t Rounded(double value) {
  constexpr double kMost = 1 << 28;  // more than can be written
  return static_cast<std::int32_t>(std::lround(std::clamp(value, -kMost, kMost)));
}

double ElevationOf(const Sighting& s) { return std::atan2(s.z_m, s.rho_m) / kRadians; }

/// Follows azimuths that rise, or fall, by `step` from one firing to the next.
class FiringCounter {
 public:
  FiringCounter(std::int32_t first, double step) : last_(first), step_(step) {}
  /// The firing of the next azimuth, which is less than a turn further on.
  double Next(std::int32_t azimuth) {
    const double turn = kTurn / std::abs(step_);
    const double further = (azimuth - last_) / step_;
    last_ = azimuth;
    firing_ += std::round(further - turn * std::floor((further + 0.5) / turn));
    return firing_ = std::max(firing_, 0.0);
  }

 private:
  std::int32_t last_;
  double step_;
  double firing_ = 0;
};

struct Sample {
  double firing;
  double elevation;
};

/// elevation = middle + cosine cos(angle firing) + sine sin(angle firing), and
/// the mean square of what that leaves.
struct Wave {
  double middle = 0;
  double cosine = 0;
  double sine = 0;
  double left = 0;
};

/// Sums of a least-squares fit.
class WaveSums {
 public:
  void Add(double cosine, double sine, double elevation) {
    const std::array<double, 4> row = {1, cosine, sine, elevation};
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned k = i; k < 4; ++k) sums_[i][k] += row[i] * row[k];
  }
  /// All 0 where nothing was added.
  Wave Solve() const {
    const double count = sums_[0][0];
    if (count == 0) return {};
    auto a = sums_;
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned k = 0; k < i; ++k) a[i][k] = a[k][i];
    for (unsigned i = 0; i < 3; ++i) {
      a[i][i] += 1e-9 * count;  // never 0
      for (unsigned row = 0; row < 4; ++row) {
        if (row == i) continue;
        const double factor = a[row][i] / a[i][i];
        for (unsigned k = i; k < 4; ++k) a[row][k] -= factor * a[i][k];
      }
    }
    return {a[0][3] / a[0][0], a[1][3] / a[1][1], a[2][3] / a[2][2], a[3][3] / count};
  }

 private:
  std::array<std::array<double, 4>, 4> sums_{};
};

Wave FitWave(const std::vector<Sample>& samples, double angle) {
  WaveSums sums;
  for (const Sample& s : samples)
    sums.Add(std::cos(angle * s.firing), std::sin(angle * s.firing), s.elevation);
  return sums.Solve();
}

/// About `most` of the samples, which tell as much.
std::vector<Sample> SomeOf(const std::vector<Sample>& samples, std::size_t most) {
  std::vector<Sample> some;
  for (std::size_t i = 0; i < samples.size(); i += samples.size() / most + 1)
    some.push_back(samples[i]);
  return some;
}

/// The angle of a firing, about, by which elevations swing.
double CoarseAngle(const std::vector<Sample>& samples, std::uint32_t firings) {
  constexpr std::uint32_t kPerLobe = 4;
  constexpr std::uint32_t kLeastPeriod = 32;  // [firings]
  const std::vector<Sample> some = SomeOf(samples, 400);
  const std::uint32_t parts = kPerLobe * firings;
  std::vector<std::array<double, 2>> waves;
  waves.reserve(parts);
  for (std::uint32_t i = 0; i < parts; ++i) {
    const double angle = 2 * M_PI * i / parts;
    waves.push_back({std::cos(angle), std::sin(angle)});
  }
  std::uint32_t best = 0;
  double least = 0;
  for (std::uint32_t candidate = kPerLobe; candidate < parts / kLeastPeriod; ++candidate) {
    WaveSums sums;
    for (const Sample& s : some) {
      const auto& wave = waves[candidate * static_cast<std::uint64_t>(s.firing) % parts];
      sums.Add(wave[0], wave[1], s.elevation);
    }
    const double left = sums.Solve().left;
    if (best > 0 && left >= least) continue;
    best = candidate;
    least = left;
  }
  return 2 * M_PI * best / parts;
}

/// The angle next to `angle` that fits best.
double FineAngle(const std::vector<Sample>& samples, std::uint32_t firings, double angle) {
  constexpr double kFinest = 1e-5;  // of what the swing turns by in all [rad]
  const std::vector<Sample> some = SomeOf(samples, 512);
  double least = FitWave(some, angle).left;
  for (double step = 1; step > kFinest; step /= 2) {
    for (const double other : {angle - step / firings, angle + step / firings}) {
      const double left = FitWave(some, other).left;
      if (left >= least) continue;
      least = left;
      angle = other;
    }
  }
  return angle;
}

/// A line through what azimuths are away from where they should be.
class AzimuthLine {
 public:
  void Add(double firing, double away) {
    n_ += 1;
    x_ += firing;
    y_ += away;
    xx_ += firing * firing;
    xy_ += firing * away;
  }
  double slope() const {
    const double spread = n_ * xx_ - x_ * x_;
    return spread > 0 ? (n_ * xy_ - x_ * y_) / spread : 0;
  }
  double start() const { return (y_ - slope() * x_) / n_; }

 private:
  double n_ = 0;
  double x_ = 0;
  double y_ = 0;
  double xx_ = 0;
  double xy_ = 0;
};

/// Firings at even steps of the azimuth.
struct EvenFirings {
  double first = 0;  // azimuth
  double step = 0;
  std::uint32_t count = 0;
  std::vector<Sample> samples;  // of the points
};

/// Adds the samples; false where the firings are too many.
bool CountFirings(const std::vector<Sighting>& points, EvenFirings* firings) {
  constexpr double kMostFirings = kMostLines * BeamTable::kMostColumns;
  FiringCounter counter(points[0].azimuth, firings->step);
  firings->samples.clear();
  for (const Sighting& s : points) {
    const double firing = counter.Next(s.azimuth);
    if (firing >= kMostFirings) return false;
    firings->samples.push_back({firing, ElevationOf(s)});
    firings->count = static_cast<std::uint32_t>(firing) + 1;
  }
  return true;
}

/// How far an azimuth is from that of its firing.
double AwayFrom(const EvenFirings& firings, const Sighting& s, double firing) {
  return std::remainder(s.azimuth - firings.first - firings.step * firing, kTurn);
}

/// Moves the firings so that azimuths lie around them.
void Align(const std::vector<Sighting>& points, EvenFirings* firings) {
  AzimuthLine line;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double firing = firings->samples[i].firing;
    line.Add(firing, AwayFrom(*firings, points[i], firing));
  }
  firings->first += line.start();
  firings->step += line.slope();
}

/// Whether most azimuths are near that of their firing.
bool AreEven(const std::vector<Sighting>& points, const EvenFirings& firings) {
  constexpr double kNear = 0.1;  // steps
  std::size_t near = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double away = AwayFrom(firings, points[i], firings.samples[i].firing);
    if (std::abs(away) < kNear * std::abs(firings.step)) ++near;
  }
  return near > points.size() * 3 / 4;
}

std::optional<EvenFirings> FindFirings(const std::vector<Sighting>& points) {
  constexpr double kLeastStep = 64;  // many times what coordinates round off
  constexpr std::size_t kLeastPoints = 64;
  if (points.size() < kLeastPoints) return std::nullopt;
  std::vector<std::int32_t> steps;
  for (std::size_t i = 1; i < points.size(); ++i)
    steps.push_back(Wrapped(points[i].azimuth - points[i - 1].azimuth));
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  EvenFirings firings;
  firings.first = points[0].azimuth;
  firings.step = *middle;
  const auto is_usual = [&] {
    return std::abs(firings.step) > kLeastStep && std::abs(firings.step) < kTurn / 16;
  };
  if (!is_usual() || !CountFirings(points, &firings)) return std::nullopt;
  Align(points, &firings);
  if (!is_usual() || !CountFirings(points, &firings) || !AreEven(points, firings))
    return std::nullopt;
  return firings;
}

/// What a swing leaves of elevations.
std::vector<Sample> LeftOf(const std::vector<Sample>& samples, double angle) {
  const Wave swing = FitWave(SomeOf(samples, 2'048), angle);
  std::vector<Sample> left = samples;
  for (Sample& s : left) {
    const double phase = angle * s.firing;
    s.elevation -= swing.middle + swing.cosine * std::cos(phase) + swing.sine * std::sin(phase);
  }
  return left;
}

/// Sums of the samples of one of several beams that fire in turn.
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

/// How many beams fire in turn, by what the swing leaves of elevations.
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

/// Takes from each elevation how far its beam is above the others.
std::vector<Sample> Levelled(std::vector<Sample> samples, const std::vector<LineSums>& lines) {
  for (Sample& s : samples)
    s.elevation -= lines[static_cast<std::uint32_t>(s.firing) % lines.size()].mean();
  return samples;
}

/// The table of `lines` beams that fire in turn, and which of them each is, in
/// the order of firing.
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

/// Whether no number is too large to be written.
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
