// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_table.h"

#include <algorithm>
#include <cstddef>
#include <map>

#include "src/codec/varint.h"

namespace lidar::codec::cloud {
namespace {

/// Elevations of one beam, in units: those of neighbours are further apart.
constexpr double kGap = 60;         // 0.005 degrees
constexpr double kWidest = 350;     // 0.03 degrees
constexpr std::size_t kFewest = 8;  // points
constexpr double kCovered = 0.6;    // part of all points

struct Seen {
  double elevation;
  std::int32_t azimuth;
};
/// Azimuths of a beam, rising.
using BeamAzimuths = std::vector<std::int32_t>;

struct FoundBeams {
  std::vector<double> elevations;  // falling
  std::vector<BeamAzimuths> azimuths;
  std::size_t points = 0;
};

FoundBeams ClusterElevations(std::vector<Seen> seen) {
  std::sort(seen.begin(), seen.end(),
            [](const Seen& a, const Seen& b) { return a.elevation > b.elevation; });
  FoundBeams found;
  for (std::size_t first = 0; first < seen.size();) {
    std::size_t end = first + 1;
    while (end < seen.size() && seen[end - 1].elevation - seen[end].elevation < kGap) ++end;
    const bool narrow = seen[first].elevation - seen[end - 1].elevation < kWidest;
    if (narrow && end - first >= kFewest) {
      found.elevations.push_back(seen[first + (end - first) / 2].elevation);
      BeamAzimuths azimuths;
      for (std::size_t i = first; i < end; ++i) azimuths.push_back(seen[i].azimuth);
      std::sort(azimuths.begin(), azimuths.end());
      found.points += azimuths.size();
      found.azimuths.push_back(std::move(azimuths));
    }
    first = end;
  }
  return found;
}

/// The usual step between neighbours, in units: the smallest that is not rare.
std::int32_t UsualStep(const std::vector<BeamAzimuths>& beams) {
  constexpr std::int32_t kLeast = kTurn / static_cast<std::int32_t>(BeamTable::kMostColumns);
  constexpr std::int32_t kClass = 64;  // 0.0055 degrees
  std::map<std::int32_t, std::size_t> histogram;
  for (const BeamAzimuths& azimuths : beams)
    for (std::size_t i = 1; i < azimuths.size(); ++i) {
      const std::int32_t step = azimuths[i] - azimuths[i - 1];
      if (step >= kLeast && step < kTurn / 64) ++histogram[(step + kClass / 2) / kClass];
    }
  std::size_t most = 0;
  for (const auto& [step, count] : histogram) most = std::max(most, count);
  for (const auto& [step, count] : histogram)
    if (5 * count >= most) return step * kClass;
  return 0;
}

/// The mean step of neighbours that are one or a few steps apart.
double MeanStep(const std::vector<BeamAzimuths>& beams, std::int32_t usual) {
  std::int64_t sum = 0;
  std::int64_t steps = 0;
  for (const BeamAzimuths& azimuths : beams)
    for (std::size_t i = 1; i < azimuths.size(); ++i) {
      const std::int32_t step = azimuths[i] - azimuths[i - 1];
      const std::int32_t count = (step + usual / 2) / usual;
      if (count < 1 || count > 4 || std::abs(step - count * usual) > usual / 4) continue;
      sum += step;
      steps += count;
    }
  return steps == 0 ? 0 : static_cast<double>(sum) / static_cast<double>(steps);
}

/// Columns of a turn in 1/kParts: a whole number where the step is as good as that.
std::uint32_t TurnOf(double step) {
  const double columns = kTurn / step;
  const double whole = std::round(columns);
  const double close = std::abs(columns - whole) < 2e-4 * columns ? whole : columns;
  return static_cast<std::uint32_t>(std::lround(close * BeamTable::kParts));
}

/// Where most azimuths of a beam lie between columns.
std::int32_t OffsetOf(const BeamAzimuths& azimuths, std::uint32_t turn) {
  constexpr std::size_t kClasses = 64;
  const double step = static_cast<double>(kTurn) * BeamTable::kParts / turn;
  std::array<std::size_t, kClasses> histogram{};
  std::vector<double> parts;
  for (const std::int32_t azimuth : azimuths) {
    const double columns = azimuth / step;
    parts.push_back(columns - std::floor(columns));
    ++histogram[std::min(static_cast<std::size_t>(parts.back() * kClasses), kClasses - 1)];
  }
  const auto peak = static_cast<std::size_t>(std::max_element(histogram.begin(), histogram.end()) -
                                             histogram.begin());
  const double middle = (static_cast<double>(peak) + 0.5) / kClasses;
  std::vector<double> near;
  for (const double part : parts) {
    const double away = part - middle - std::round(part - middle);
    if (std::abs(away) < 0.25) near.push_back(away);
  }
  std::nth_element(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2),
                   near.end());
  const double offset = middle + near[near.size() / 2];
  return static_cast<std::int32_t>(std::lround((offset - std::floor(offset)) * step));
}

}  // namespace

Sighting::Sighting(const Point& point) {
  const double x = static_cast<double>(point[0]);
  const double y = static_cast<double>(point[1]);
  const double z = static_cast<double>(point[2]);
  rho_m = std::sqrt(x * x + y * y);
  range_m = std::sqrt(x * x + y * y + z * z);
  elevation = std::atan2(z, rho_m) / kRadians;
  azimuth = static_cast<std::int32_t>(std::lround(std::atan2(y, x) / kRadians)) & (kTurn - 1);
}

std::uint32_t BeamTable::ColumnOf(std::uint32_t beam, std::int32_t azimuth) const {
  const auto away = static_cast<std::uint64_t>((azimuth - beams[beam].offset) & (kTurn - 1));
  const std::uint64_t column = (away * turn + std::uint64_t{kTurn} * kParts / 2) >> (kTurnBits + 8);
  return column >= columns() ? 0 : static_cast<std::uint32_t>(column);
}

std::uint32_t BeamTable::BeamOf(double elevation) const {
  const auto below = std::lower_bound(
      beams.begin(), beams.end(), elevation,
      [](const Beam& beam, double e) { return static_cast<double>(beam.elevation) > e; });
  if (below == beams.begin()) return 0;
  const auto index = static_cast<std::uint32_t>(below - beams.begin());
  if (below == beams.end()) return index - 1;
  const double to_above = beams[index - 1].elevation - elevation;
  return to_above < elevation - below->elevation ? index - 1 : index;
}

Point BeamTable::At(std::uint32_t beam, std::int32_t azimuth, std::uint32_t range_mm) const {
  const double range = 1e-3 * range_mm;
  const double elevation = beams[beam].elevation * kRadians;
  const double angle = (azimuth & (kTurn - 1)) * kRadians;
  const double rho = range * std::cos(elevation);
  return {static_cast<float>(rho * std::cos(angle)), static_cast<float>(rho * std::sin(angle)),
          static_cast<float>(range * std::sin(elevation))};
}

void BeamTable::Write(ByteWriter* writer) const {
  WriteVarint(turn, writer);
  WriteVarint(rows(), writer);
  std::int32_t above = kTurn / 4;
  for (const Beam& beam : beams) {
    WriteVarint(static_cast<std::uint32_t>(above - beam.elevation), writer);
    WriteVarint(static_cast<std::uint32_t>(beam.offset), writer);
    above = beam.elevation;
  }
}

std::optional<BeamTable> BeamTable::Read(ByteReader* reader) {
  bool ok = true;
  BeamTable table;
  table.turn = ReadVarint(reader, &ok);
  const std::uint32_t rows = ReadVarint(reader, &ok);
  if (!ok || table.turn < kParts || table.turn > kMostColumns * kParts || rows == 0 ||
      rows > kMostBeams) {
    return std::nullopt;
  }
  std::int64_t elevation = kTurn / 4;
  for (std::uint32_t i = 0; i < rows; ++i) {
    elevation -= ReadVarint(reader, &ok);
    const std::uint32_t offset = ReadVarint(reader, &ok);
    if (!ok || !reader->ok() || elevation < -kTurn / 4 || offset >= kTurn) return std::nullopt;
    table.beams.push_back(
        {static_cast<std::int32_t>(elevation), static_cast<std::int32_t>(offset)});
  }
  return table;
}

std::optional<BeamTable> FindBeams(const std::vector<Sighting>& points) {
  std::vector<Seen> seen;
  seen.reserve(points.size());
  for (const Sighting& s : points) seen.push_back({s.elevation, s.azimuth});
  const FoundBeams found = ClusterElevations(std::move(seen));
  if (found.azimuths.empty() || found.azimuths.size() > BeamTable::kMostBeams ||
      static_cast<double>(found.points) < kCovered * static_cast<double>(points.size())) {
    return std::nullopt;
  }
  const std::int32_t usual = UsualStep(found.azimuths);
  if (usual == 0) return std::nullopt;
  BeamTable table;
  const double step = MeanStep(found.azimuths, usual);
  if (step <= 0) return std::nullopt;
  table.turn = TurnOf(step);
  if (table.columns() == 0 || table.columns() > BeamTable::kMostColumns) return std::nullopt;
  for (std::size_t i = 0; i < found.azimuths.size(); ++i) {
    table.beams.push_back({static_cast<std::int32_t>(std::lround(found.elevations[i])),
                           OffsetOf(found.azimuths[i], table.turn)});
  }
  return table;
}

}  // namespace lidar::codec::cloud
