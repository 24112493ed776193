// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_table.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "src/codec/varint.h"

namespace lidar::codec::cloud {
namespace {

void WriteSigned(std::int32_t value, ByteWriter* writer) {
  const auto size = static_cast<std::uint32_t>(std::abs(value));
  WriteVarint(size << 1 | (value < 0 ? 1U : 0U), writer);
}

std::int32_t ReadSigned(ByteReader* reader, bool* ok) {
  const std::uint32_t value = ReadVarint(reader, ok);
  const auto size = static_cast<std::int32_t>(value >> 1);
  return (value & 1) != 0 ? -size : size;
}

/// The flags of a table.
constexpr unsigned kOffsetsFlag = 1;
constexpr unsigned kGrainsFlag = 2;
constexpr unsigned kReachesFlag = 4;
constexpr unsigned kPeriodShift = 3;  // the period is stored minus 1
constexpr unsigned kBendsFlag = 32;
constexpr unsigned kPathFlag = 64;
constexpr unsigned kLaterFlag = 128;

/// The arc tangents of k / kParts, for each k up to kParts.
class ArcTable {
 public:
  static constexpr int kParts = 64;
  constexpr ArcTable() {
    for (int k = 1; k <= kParts; ++k) {
      const double last = (k - 1.0) / kParts;
      angles_[k] = angles_[k - 1] + OfSmall(1.0 / kParts / (1 + last * k / kParts));
    }
  }
  /// Returns the arc tangent of `t`, which is at most 1 / kParts, with the precision of a double.
  static constexpr double OfSmall(double t) {
    const double s = t * t;
    return t * (1 - s * (1.0 / 3 - s * (1.0 / 5 - s * (1.0 / 7 - s / 9))));
  }
  constexpr double operator[](int k) const { return angles_[k]; }

 private:
  double angles_[kParts + 1] = {};
};
constexpr ArcTable kArcs;

/// The sines of k / kParts turns, for each k below kParts.
class SineTable {
 public:
  static constexpr std::int32_t kParts = 1'024;
  constexpr SineTable() {
    for (int k = 0; k < kParts; ++k) {
      // The nearest quarter of a turn decides which series is used, and with which sign.
      const int quarter = (k + kParts / 8) / (kParts / 4);
      const double rest = (k - quarter * (kParts / 4)) * (2 * M_PI / kParts);
      const double series = quarter % 2 == 0 ? SineOf(rest) : CosineOf(rest);
      sines_[k] = quarter % 4 < 2 ? series : -series;
    }
  }
  /// SineOf() and CosineOf() are for angles of up to an eighth of a turn. They have the precision
  /// of a double.
  static constexpr double SineOf(double t) {
    double sum = 0;
    for (int n = 19; n > 1; n -= 2) sum = -(sum + 1) * t * t / (n * (n - 1));
    return t * (sum + 1);
  }
  static constexpr double CosineOf(double t) {
    double sum = 0;
    for (int n = 20; n > 1; n -= 2) sum = -(sum + 1) * t * t / (n * (n - 1));
    return sum + 1;
  }
  constexpr double operator[](std::int32_t k) const { return sines_[k & (kParts - 1)]; }

 private:
  double sines_[kParts] = {};
};
const SineTable kSines;

}  // namespace

double AngleOf(double y, double x) {
  const double wide = std::max(std::abs(x), std::abs(y));
  const double narrow = std::min(std::abs(x), std::abs(y));
  if (!(wide > 0)) return 0;
  const int k = static_cast<int>(narrow / wide * ArcTable::kParts + 0.5);
  const double part = k * (1.0 / ArcTable::kParts);
  double angle = kArcs[k] + ArcTable::OfSmall((narrow - part * wide) / (wide + part * narrow));
  if (std::abs(y) > std::abs(x)) angle = M_PI / 2 - angle;
  if (x < 0) angle = M_PI - angle;
  return y < 0 ? -angle : angle;
}

/// Computes the cosine and the sine from kSines. Calls of std::sin() and std::cos() would take four
/// times as long.
BeamTable::Slope::Slope(double angle) {
  constexpr std::int32_t kPart = kTurn / SineTable::kParts;
  const std::int32_t k = ToNearest(angle * (1.0 / kPart));
  const double t = (angle - static_cast<double>(k) * kPart) * kRadians;
  const double square = t * t;
  const double s = t * (1 - square * (1.0 / 6 - square * (1.0 / 120)));
  const double c = 1 - square * (1.0 / 2 - square * (1.0 / 24 - square * (1.0 / 720)));
  const double sine_k = kSines[k];
  const double cosine_k = kSines[k + SineTable::kParts / 4];
  cosine = cosine_k * c - sine_k * s;
  sine = sine_k * c + cosine_k * s;
}

Sighting::Sighting(const Point& point) {
  const double x = static_cast<double>(point[0]);
  const double y = static_cast<double>(point[1]);
  z_m = static_cast<double>(point[2]);
  rho_m = std::sqrt(x * x + y * y);
  range_m = std::sqrt(x * x + y * y + z_m * z_m);
  azimuth = ToNearest(AngleOf(y, x) / kRadians) & (kTurn - 1);
}

void SightAll(const std::vector<Point>& points, std::size_t count,
              std::vector<Sighting>* sightings) {
  sightings->resize(count);
  for (std::size_t i = 0; i < count; ++i) (*sightings)[i] = Sighting(points[i]);
}

bool BeamTable::has_offsets() const {
  return std::any_of(beams.begin(), beams.end(),
                     [](const Beam& b) { return b.height_um != 0 || b.side_um != 0; });
}

ColumnAngles::ColumnAngles(const BeamTable& table) : table_(table), angles_(table.columns()) {
  BeamTable one;
  one.turn = table.turn;
  one.grains = table.grains;
  one.places = table.places;
  one.beams.resize(1);
  for (std::uint32_t i = 0; i < angles_.size(); ++i) angles_[i] = one.AzimuthOf(0, i);
}

ColumnFinder::ColumnFinder(const BeamTable& table) : table_(table), angles_(table) {
  for (const BeamTable::Beam& beam : table.beams)
    swings_.push_back(table.period > 1 && beam.Swings());
  const std::vector<std::int32_t>& angles = angles_.firings();
  around_.push_back(angles.back());
  around_.insert(around_.end(), angles.begin(), angles.end());
  around_.insert(around_.end(), {angles.front(), angles[angles.size() > 1 ? 1 : 0]});
  if (table.places.empty()) return;
  buckets_.reserve(1U << (kTurnBits - kShift));
  std::uint32_t place = 0;
  for (std::int32_t i = 0; i < 1 << (kTurnBits - kShift); ++i) {
    while (place < table.columns() && angles[place] < i << kShift) ++place;
    buckets_.push_back(static_cast<std::uint16_t>(place));
  }
}

ColumnFinder::Found ColumnFinder::Find(std::uint32_t beam, std::int32_t azimuth) const {
  const BeamTable::Beam& b = table_.beams[beam];
  const std::int32_t away = azimuth & (kTurn - 1);
  const std::vector<std::int32_t>& angles = angles_.firings();
  const std::uint32_t columns = table_.columns();
  const auto place = static_cast<std::uint32_t>(away);
  const std::uint64_t parts = std::uint64_t{place} * table_.turn;
  if (buckets_.empty() && table_.period == 1) {
    const std::uint64_t half = std::uint64_t{kTurn} * BeamTable::kParts / 2;
    const auto nearest = static_cast<std::uint32_t>((parts + half) >> (kTurnBits + 8));
    const std::uint32_t column = nearest >= columns ? 0 : nearest;
    return {column, Wrapped(away - angles[table_.FiringOf(beam, column)])};
  }
  // A bucket has less than one column on average.
  const std::uint32_t first = buckets_.empty()
                                  ? static_cast<std::uint32_t>(parts >> (kTurnBits + 8))
                                  : buckets_[place >> kShift];
  if (!swings_[beam]) return NearestOf(b, first, away);
  constexpr std::uint32_t kAround = 2;
  std::uint32_t firing = first + 2 * columns - kAround;
  while (firing >= columns) firing -= columns;
  std::uint32_t phase = firing % table_.period;
  std::uint32_t best = 0;
  std::int32_t residual = kTurn;
  for (std::uint32_t step = 0; step <= 2 * kAround; ++step) {
    const std::int32_t off = Wrapped(away - angles[firing] - b.swings[phase]);
    if (std::abs(off) < std::abs(residual)) {
      residual = off;
      best = firing;
    }
    if (++phase >= table_.period) phase = 0;
    if (++firing == columns) firing = phase = 0;
  }
  return {table_.ColumnOf(b, best), residual};
}

/// Returns the nearest of three firings: `first`, the firing before it and the firing after it. The
/// code has no jumps, because a processor would mispredict them.
ColumnFinder::Found ColumnFinder::NearestOf(const BeamTable::Beam& beam, std::uint32_t first,
                                            std::int32_t away) const {
  const std::int32_t* const at = &around_[first];
  std::uint32_t best = first + table_.columns() - 1;
  std::int32_t residual = Wrapped(away - at[0]);
  for (std::uint32_t k = 1; k < 3; ++k) {
    const std::int32_t off = Wrapped(away - at[k]);
    const bool is_nearer = std::abs(off) < std::abs(residual);
    best = is_nearer ? first + table_.columns() - 1 + k : best;
    residual = is_nearer ? off : residual;
  }
  while (best >= table_.columns()) best -= table_.columns();
  return {table_.ColumnOf(beam, best), residual};
}

Point BeamTable::At(std::uint32_t beam, std::int32_t azimuth, const Slope& slope,
                    std::uint32_t range_mm) const {
  const Beam& b = beams[beam];
  const double range = 1e-3 * range_mm + 1e-6 * b.reach_um;
  const double rho = range * slope.cosine;
  const Slope across((azimuth & (kTurn - 1)) + SideAngle(b, rho));
  return {static_cast<float>(rho * across.cosine), static_cast<float>(rho * across.sine),
          static_cast<float>(range * slope.sine + 1e-6 * b.height_um)};
}

void BeamTable::Write(ByteWriter* writer) const {
  WriteVarint(turn, writer);
  WriteVarint(rows(), writer);
  writer->U8(static_cast<std::uint8_t>((grains == 0 ? 0 : kGrainsFlag) |
                                       (period - 1) << kPeriodShift | (bends ? kBendsFlag : 0) |
                                       (has_path() ? kPathFlag : kLaterFlag)));
  if (grains > 0) WriteVarint(grains, writer);
  if (has_path()) WriteSigned(rate, writer);
}

std::optional<BeamTable> BeamTable::Read(ByteReader* reader) {
  bool ok = true;
  BeamTable table;
  table.turn = ReadVarint(reader, &ok);
  const std::uint32_t rows = ReadVarint(reader, &ok);
  const unsigned all_flags = reader->U8();
  table.beams_follow = (all_flags & kLaterFlag) != 0;
  const unsigned flags = all_flags & ~kLaterFlag;
  table.bends = (flags & kBendsFlag) != 0;
  table.period = ((flags & ~(kBendsFlag | kPathFlag)) >> kPeriodShift) + 1;
  if (!ok || table.turn < kParts || table.turn > kMostColumns * kParts || rows == 0 ||
      rows > kMostBeams || table.period > kMostPeriod) {
    return std::nullopt;
  }
  if ((flags & kGrainsFlag) != 0) {
    table.grains = ReadVarint(reader, &ok);
    if (table.grains == 0 || table.grains > kMostGrains) return std::nullopt;
    table.places.assign(table.columns(), 0);
  }
  if ((flags & kPathFlag) != 0) {
    table.rate = ReadSigned(reader, &ok);
    table.beams.resize(rows);
    table.path.resize(rows);
    if (!ok || !table.has_path() || std::abs(table.rate) > BeamPath::kMostRate ||
        rows > kMostPathBeams || (all_flags & ~kBendsFlag) != kPathFlag)
      return std::nullopt;
    return table;
  }
  if (table.beams_follow) {
    table.beams.resize(rows);
    if (!ok || !reader->ok() || (flags & (kOffsetsFlag | kReachesFlag)) != 0) return std::nullopt;
    return table;
  }
  // Earlier encoders wrote the beams here.
  std::int64_t elevation = kTurn / 4;
  Beam beam;
  for (std::uint32_t i = 0; i < rows; ++i) {
    elevation -= std::int64_t{ReadVarint(reader, &ok)} * (table.bends ? kBentElevation : 1);
    beam.elevation = static_cast<std::int32_t>(elevation);
    if (table.bends) {
      const std::int64_t offset = beam.offset + std::int64_t{ReadSigned(reader, &ok)} * kBentOffset;
      beam.offset = static_cast<std::int32_t>(offset & (kTurn - 1));
    } else {
      beam.offset = static_cast<std::int32_t>(ReadVarint(reader, &ok));
    }
    if ((flags & kOffsetsFlag) != 0) {
      beam.height_um += ReadSigned(reader, &ok);
      beam.side_um += ReadSigned(reader, &ok);
    }
    if ((flags & kReachesFlag) != 0) beam.reach_um = ReadSigned(reader, &ok);
    bool fits = std::max({std::abs(beam.height_um), std::abs(beam.side_um),
                          std::abs(beam.reach_um)}) <= kMostOffsetUm;
    if (table.grains > 0 && !table.bends) beam.delay = ReadVarint(reader, &ok);
    fits = fits && beam.delay < table.columns();
    for (std::uint32_t k = 0; k < table.period && table.period > 1; ++k) {
      const std::int32_t swing = ReadSigned(reader, &ok);
      fits = fits && std::abs(swing) <= kTurn / kSwingUnit;
      beam.swings[k] = fits ? swing * kSwingUnit : 0;
    }
    if (!ok || !reader->ok() || elevation < -kTurn / 4 || beam.offset >= kTurn || !fits)
      return std::nullopt;
    table.beams.push_back(beam);
  }
  return table;
}

}  // namespace lidar::codec::cloud
