// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/column_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <map>

namespace lidar::codec::cloud {
namespace {

constexpr std::int32_t kLeastStep = kTurn / static_cast<std::int32_t>(BeamTable::kMostColumns);
constexpr std::int32_t kMostStep = kTurn / 64;

/// Returns the most common step between neighbouring points of a beam, in angle units. Returns 0 if
/// there is none.
std::int32_t UsualStep(const BeamAzimuths& azimuths) {
  constexpr std::int32_t kClass = 64;  // 0.0055 degrees
  std::map<std::int32_t, std::size_t> histogram;
  for (std::size_t i = 1; i < azimuths.size(); ++i) {
    const std::int32_t step = azimuths[i].azimuth - azimuths[i - 1].azimuth;
    if (step >= kLeastStep && step < kMostStep) ++histogram[(step + kClass / 2) / kClass];
  }
  std::int32_t usual = 0;
  std::size_t most = 0;
  for (const auto& [step, count] : histogram) {
    if (count <= most) continue;
    most = count;
    usual = step * kClass;
  }
  return usual;
}

std::complex<double> PhaseOf(double columns) { return std::polar(1.0, 2 * M_PI * columns); }

/// Returns a measure of how well a sample of points lies in columns. It is at most the number of
/// points in the sample.
double Alignment(const std::vector<BeamAzimuths>& beams, double step) {
  constexpr std::size_t kSample = 150;  // points of each beam
  double sum = 0;
  for (const BeamAzimuths& azimuths : beams) {
    const std::size_t stride = azimuths.size() / kSample + 1;
    std::complex<double> phases;
    for (std::size_t i = 0; i < azimuths.size(); i += stride)
      phases += PhaseOf(azimuths[i].azimuth / step);
    sum += std::abs(phases);
  }
  return sum;
}

}  // namespace

std::int32_t UsualStep(const std::vector<BeamAzimuths>& beams) {
  std::map<std::int32_t, std::size_t> points;
  std::size_t all = 0;
  for (const BeamAzimuths& azimuths : beams) {
    const std::int32_t step = UsualStep(azimuths);
    if (step > 0) points[step] += azimuths.size();
    all += azimuths.size();
  }
  for (const auto& [step, count] : points)
    if (10 * count >= all) return step;
  return 0;
}

double MeanStep(const std::vector<BeamAzimuths>& beams, std::int32_t usual) {
  std::int64_t sum = 0;
  std::int64_t steps = 0;
  for (const BeamAzimuths& azimuths : beams)
    for (std::size_t i = 1; i < azimuths.size(); ++i) {
      const std::int32_t step = azimuths[i].azimuth - azimuths[i - 1].azimuth;
      const std::int32_t count = (step + usual / 2) / usual;
      if (count < 1 || count > 4 || std::abs(step - count * usual) > usual / 4) continue;
      sum += step;
      steps += count;
    }
  return steps == 0 ? 0 : static_cast<double>(sum) / static_cast<double>(steps);
}

double AlignedStep(const std::vector<BeamAzimuths>& beams, double step) {
  const double columns = kTurn / step;
  double best = columns;
  double most = 0;
  const auto search = [&](double middle, double pace, int reach) {
    for (int i = -reach; i <= reach; ++i) {
      const double other = middle + pace * i;
      const double alignment = Alignment(beams, kTurn / other);
      if (alignment <= most) continue;
      most = alignment;
      best = other;
    }
  };
  search(std::round(columns), 1, 15);
  most *= 1.01;
  search(best, 0.25, 6);
  search(best, 0.0625, 3);
  return kTurn / best;
}

double PhaseAt(const BeamAzimuths& azimuths, double step) {
  constexpr std::size_t kPhases = 64;
  std::array<std::size_t, kPhases> histogram{};
  std::vector<double> parts;
  for (const BeamAzimuth& a : azimuths) {
    const double columns = a.azimuth / step;
    parts.push_back(columns - std::floor(columns));
    ++histogram[std::min(static_cast<std::size_t>(parts.back() * kPhases), kPhases - 1)];
  }
  const auto peak = static_cast<std::size_t>(std::max_element(histogram.begin(), histogram.end()) -
                                             histogram.begin());
  const double middle = (static_cast<double>(peak) + 0.5) / kPhases;
  std::vector<double> near;
  for (const double part : parts) {
    const double away = part - middle - std::round(part - middle);
    if (std::abs(away) < 0.25) near.push_back(away);
  }
  std::nth_element(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2),
                   near.end());
  const double offset = middle + near[near.size() / 2];
  return offset - std::floor(offset);
}

Side SideOf(const BeamAzimuths& azimuths, double step) {
  constexpr std::size_t kSample = 300;
  const std::size_t stride = azimuths.size() / kSample + 1;
  Side best;
  const auto search = [&](std::int32_t middle, std::int32_t reach, std::int32_t pace) {
    for (std::int32_t side = middle - reach; side <= middle + reach; side += pace) {
      BeamTable::Beam beam;
      beam.side_um = side;
      std::complex<double> phases;
      std::size_t count = 0;
      for (std::size_t i = 0; i < azimuths.size(); i += stride, ++count) {
        const double angle = SideAngle(beam, static_cast<double>(azimuths[i].rho_m));
        phases += PhaseOf((azimuths[i].azimuth - angle) / step);
      }
      const double alignment = std::abs(phases) / static_cast<double>(count);
      if (alignment > best.alignment) best = {side, alignment};
    }
  };
  search(0, 48'000, 2'000);
  search(best.side_um, 1'500, 500);
  search(best.side_um, 400, 100);
  return best;
}

double QuantumOf(const std::vector<BeamAzimuths>& beams, std::int32_t usual, double step) {
  std::int64_t sum = 0;
  std::int64_t count = 0;
  for (const BeamAzimuths& azimuths : beams)
    for (std::size_t i = 1; i < azimuths.size(); ++i) {
      const std::int32_t away = azimuths[i].azimuth - azimuths[i - 1].azimuth;
      if (std::abs(away - usual) > usual / 6) continue;
      sum += away;
      ++count;
    }
  if (count == 0) return step;
  const double mean = static_cast<double>(sum) / static_cast<double>(count);
  const double whole = kTurn / std::round(kTurn / mean);
  double best = step;
  double most = 0;
  for (const double quantum : {step, mean, whole, whole / 2}) {
    double alignment = 0;
    for (std::size_t b = 0; b < beams.size(); b += beams.size() / 8 + 1)
      alignment += SideOf(beams[b], quantum).alignment;
    if (alignment <= 1.02 * most) continue;
    most = alignment;
    best = quantum;
  }
  return best;
}

double MeanPhase(const BeamAzimuths& azimuths, double step) {
  std::complex<double> phases;
  for (const BeamAzimuth& a : azimuths) phases += PhaseOf(a.azimuth / step);
  return std::arg(phases) / (2 * M_PI);
}

}  // namespace lidar::codec::cloud
