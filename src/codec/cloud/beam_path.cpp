// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

BeamPath::Terms BeamPath::TermsAt(std::uint32_t column) const {
  // The Chebyshev polynomials are computed by their recursion.
  std::array<double, kPathDegrees[0] + 1> powers{};
  const double x = (2.0 * column + 1) / columns_ - 1;
  powers[0] = 1;
  powers[1] = x;
  for (std::size_t i = 2; i < powers.size(); ++i) powers[i] = 2 * x * powers[i - 1] - powers[i - 2];
  const double phase = static_cast<double>(TurnAt(column) & (kTurn - 1)) * kRadians;
  const double cosine = std::cos(phase);
  const double sine = std::sin(phase);
  const std::array<double, 5> waves = {1, cosine, sine, cosine * cosine - sine * sine,
                                       2 * cosine * sine};
  Terms terms{};
  std::size_t term = 0;
  for (std::size_t wave = 0; wave < waves.size(); ++wave)
    for (unsigned i = 0; i <= kPathDegrees[(wave + 1) / 2]; ++i)
      terms[term++] = waves[wave] * powers[i];
  return terms;
}

std::vector<PathDirection> BeamPath::Trace(const std::vector<PathBeam>& beams, std::uint32_t first,
                                           std::uint32_t count) const {
  // Terms that no curve uses are left out, because they would take half of the time.
  std::vector<std::size_t> used;
  std::vector<std::array<double, 2>> factors;  // of the used terms, for each beam
  for (std::size_t term = 0; term < kPathTerms; ++term)
    if (std::any_of(beams.begin(), beams.end(), [&](const PathBeam& b) {
          return b.azimuth[term] != 0 || b.elevation[term] != 0;
        }))
      used.push_back(term);
  for (const PathBeam& b : beams)
    for (const std::size_t term : used)
      factors.push_back({static_cast<double>(kPathUnit * b.azimuth[term]),
                         static_cast<double>(kPathUnit * b.elevation[term])});
  std::vector<PathDirection> directions(beams.size() * count);
  for (std::uint32_t column = 0; column < count; ++column) {
    const Terms terms = TermsAt(first + column);
    const auto turn = static_cast<std::int32_t>(TurnAt(first + column) & (kTurn - 1));
    auto factor = factors.begin();
    for (std::size_t beam = 0; beam < beams.size(); ++beam) {
      std::array<double, 2> sums{};
      for (const std::size_t term : used) {
        sums[0] += terms[term] * (*factor)[0];
        sums[1] += terms[term] * (*factor++)[1];
      }
      directions[beam * count + column] = {turn + static_cast<std::int32_t>(std::lround(sums[0])),
                                           static_cast<std::int32_t>(std::lround(sums[1]))};
    }
  }
  return directions;
}

}  // namespace lidar::codec::cloud
