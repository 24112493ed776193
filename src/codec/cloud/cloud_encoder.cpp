// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/cloud_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "src/base/byte_writer.h"
#include "src/cloud/field_number.h"
#include "src/codec/cloud/level_tree.h"
#include "src/codec/effort_control.h"
#include "src/codec/mixing/binary_coder.h"
#include "src/codec/varint.h"

namespace lidar::codec::cloud {
namespace {

/// The largest number of points for which cells are chosen. The choice takes some 100 bytes of
/// memory per point.
constexpr std::size_t kMostToChoose = 1U << 20;
constexpr std::size_t kMostPoints = (1U << 28) - 1;

double ErrorOf(const SliceSettings& settings) {
  const double asked = settings.step_m * std::sqrt(3.0) / 2;
  return asked > 0 ? std::min(asked, settings.max_error_m) : settings.max_error_m;
}

IntensityScale ScaleOf(const XyzCloud& cloud, unsigned bits) {
  if (cloud.intensity.empty()) return {};
  const float largest = *std::max_element(cloud.intensity.begin(), cloud.intensity.end());
  return {IntensityScale::Fitting(largest), bits};
}

bool HasPulses(const PointFields& fields) {
  return fields.Has("line", FieldType::kU8) && fields.Find("timestamp") != nullptr;
}

/// Returns the largest coordinate, without sign. The bits of floats without sign have the same
/// order as the floats, so the bits are compared.
float FarthestOf(const std::vector<float>& xyz) {
  std::int32_t most = 0;
  for (const float v : xyz) {
    std::int32_t bits;
    std::memcpy(&bits, &v, sizeof bits);
    most = std::max(most, bits & INT32_MAX);
  }
  float farthest;
  std::memcpy(&farthest, &most, sizeof farthest);
  return farthest;
}

/// Divides the error between ranges and azimuths in the way that probably gives the smallest cloud.
PixelErrors CheapestErrors(PlacedCloud cloud, double error_m) {
  // It suffices to use a part of the points.
  constexpr std::size_t kSample = 8'192;
  cloud.stride = cloud.points->size() / kSample + 1;
  // The assumed number of bits of a point without a pixel, and of a residual.
  constexpr double kRestBits = 10;
  constexpr double kResidualBits = 0.8;
  const bool has_path = cloud.table->has_path();
  const bool bends = cloud.table->bends;
  const std::uint32_t unit_mm =
      CommonUnit(FittingRanges(cloud, {error_m, 0, 0, bends ? 1U : 0U}), 1);
  const auto all = static_cast<double>(cloud.points->size() / cloud.stride);
  PixelErrors best;
  double least = 0;
  for (const double part : {1.0, 0.95, 0.9, -0.95, -0.85}) {
    // Pixels of bending beams are always coded with residuals, which a negative `part` stands for.
    if (bends && part > 0) continue;
    PixelErrors errors;
    errors.error_m = error_m;
    const auto grid = RangeGrid::ForError(std::abs(part) * error_m, unit_mm);
    errors.range_m = grid.error_m();
    if (part < 0) {
      // A tenth of the error is left for the rounding to integers.
      const double both_m = 0.9 * std::sqrt(error_m * error_m - errors.range_m * errors.range_m);
      const double each_m = bends || has_path ? both_m / std::sqrt(2.0) : both_m;
      errors.tangent_um = std::max(static_cast<std::uint32_t>(1e6 * each_m), 1U);
      if (bends || has_path) errors.bend_um = errors.tangent_um;
    }
    const double fitting_bits = (part < 0 ? kResidualBits : 0) - std::log2(grid.step_m());
    // The slow count is skipped if this choice would lose even with all points in pixels.
    if (best.error_m > 0 && all * std::min(fitting_bits, kRestBits) >= least) continue;
    const auto fitting = static_cast<double>(CountFitting(cloud, errors));
    const double bits = kRestBits * (all - fitting) + fitting * fitting_bits;
    if (best.error_m > 0 && bits >= least) continue;
    best = errors;
    least = bits;
  }
  return best;
}

/// Returns how ranges are coded at an effort below the highest.
RangeWay WayOf(unsigned effort) {
  constexpr std::array<RangeCoder, EffortControl::kHighest> kCoders = {
      RangeCoder::kAdaptive, RangeCoder::kBlended, RangeCoder::kMixing};
  return {kCoders[effort], effort};
}

/// Returns the distance from the sensor up to which cells are cheaper than ranges, in multiples of
/// the error. Up to this distance the mean step between pixels is below kCloseTogether times the
/// error. The distance is at most kMost, because many cells take more time than ranges.
double UsualReach(const BeamTable& table) {
  constexpr double kMost = 70;
  constexpr double kCloseTogether = 0.45;
  if (table.has_path()) return kMost;
  const double column = table.step();
  const double all = table.beams.front().elevation - table.beams.back().elevation;
  const double beam = std::max(all / std::max(table.rows() - 1, 1U), column);
  return std::min(kCloseTogether / (kRadians * std::sqrt(column * beam)), kMost);
}
/// The reaches that are tried, in multiples of the usual reach.
constexpr std::array<double, 8> kReaches = {0, 0.3, 0.5, 0.7, 1, 1.4, 2, 3};

}  // namespace

std::optional<CloudEncoder> CloudEncoder::Create(const CloudLayout& layout, ExactChoice exact) {
  if (!layout.fields.HasPackedXyz()) return std::nullopt;
  return CloudEncoder(layout, std::move(exact));
}

void CloudEncoder::Load(ByteView raw, bool with_intensity) {
  std::vector<std::uint32_t> rows;
  const bool needs_rows = HasPulses(layout_.fields) || !choice_.fields.empty();
  ReadXyz(raw, layout_, with_intensity && HasIntensity(layout_.fields), &cloud_,
          needs_rows ? &rows : nullptr);
  LoadPulses(raw, rows);
  exact_.clear();
  for (const PointField& field : choice_.fields) {
    ExactField& exact = exact_.emplace_back();
    exact.type = field.type;
    exact.numbers.assign(rows.size(), 0);
    const std::size_t size = SizeOf(field.type);
    for (std::size_t i = 0; i < rows.size(); ++i)
      std::memcpy(&exact.numbers[i],
                  raw.data + std::size_t{rows[i]} * layout_.point_step + field.offset, size);
  }
}

/// Loads the lines and times of the points, if there are any. They help with sensors whose scans do
/// not repeat.
void CloudEncoder::LoadPulses(ByteView raw, const std::vector<std::uint32_t>& rows) {
  pulses_.clear();
  if (!HasPulses(layout_.fields)) return;
  const PointField* line = layout_.fields.Find("line");
  const PointField* time = layout_.fields.Find("timestamp");
  for (const std::uint32_t row : rows) {
    const std::uint8_t* point = raw.data + std::size_t{row} * layout_.point_step;
    pulses_.push_back({point[line->offset], ReadNumber(point + time->offset, time->type)});
  }
}

double CloudEncoder::extent_m() const {
  double extent = 0;
  for (std::size_t k = 0; k < 3 && !cloud_.xyz.empty(); ++k) {
    float least = cloud_.xyz[k];
    float most = least;
    for (std::size_t i = k; i < cloud_.xyz.size(); i += 3) {
      least = std::min(least, cloud_.xyz[i]);
      most = std::max(most, cloud_.xyz[i]);
    }
    extent = std::max(extent, static_cast<double>(most) - static_cast<double>(least));
  }
  return extent;
}

void CloudEncoder::Thin(const std::vector<bool>& kept) {
  for (ExactField& field : exact_) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (kept[i]) field.numbers[count++] = field.numbers[i];
    field.numbers.resize(count);
  }
  std::vector<Pulse> pulses;
  XyzCloud thinned;
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (!kept[i]) continue;
    if (!pulses_.empty()) pulses.push_back(pulses_[i]);
    thinned.xyz.insert(thinned.xyz.end(), &cloud_.xyz[3 * i], &cloud_.xyz[3 * i] + 3);
    if (!cloud_.intensity.empty()) thinned.intensity.push_back(cloud_.intensity[i]);
  }
  cloud_ = std::move(thinned);
  pulses_ = std::move(pulses);
}

/// Moves the points that the grid cannot hold to `far_ids_`, and the others to `near_`. Returns the
/// largest coordinate in `near_`, without sign.
float CloudEncoder::SortOutFarPoints(const CellGrid& grid) {
  float most = 0;
  const double surely = grid.SurelyHolds();
  // The lists still have the points of the previous cloud, so resize() writes few zeros.
  near_.resize(cloud_.size());
  near_ids_.resize(cloud_.size());
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < cloud_.size(); ++i) {
    const Point point = {cloud_.xyz[3 * i], cloud_.xyz[3 * i + 1], cloud_.xyz[3 * i + 2]};
    const float x = std::abs(point[0]);
    const float y = std::abs(point[1]);
    const float z = std::abs(point[2]);
    const float farthest = std::max({x, y, z});
    const double sum = static_cast<double>(x) + static_cast<double>(y) + static_cast<double>(z);
    if (sum > surely && (!grid.Reaches(static_cast<double>(farthest)) || !grid.Holds(point))) {
      far_ids_.push_back(i);
      continue;
    }
    most = std::max(most, farthest);
    near_[count] = point;
    near_ids_[count++] = i;
  }
  near_.resize(count);
  near_ids_.resize(count);
  return most;
}

/// Separates the points that the grid can hold from the points that are too far away.
void CloudEncoder::SortOut(CloudHeader* header) {
  far_ids_.clear();
  float most = FarthestOf(cloud_.xyz);
  const double surely = header->grid.SurelyHolds();
  if (3 * static_cast<double>(most) <= surely) {
    near_ids_.resize(cloud_.size());
    std::iota(near_ids_.begin(), near_ids_.end(), 0U);
    near_.resize(cloud_.size());
    std::memcpy(near_.data(), cloud_.xyz.data(), cloud_.xyz.size() * sizeof(float));
  } else {
    most = SortOutFarPoints(header->grid);
  }
  levels_.clear();
  const IntensityScale fine(header->intensity.full(), kFineIntensityBits);
  for (std::size_t i = 0; i < near_ids_.size() && header->intensity.bits() > 0; ++i)
    levels_.push_back(fine.LevelOf(cloud_.intensity[near_ids_[i]]));
  header->depth = std::max(header->depth, header->grid.DepthFor(static_cast<double>(most)));
  header->far_points = static_cast<std::uint32_t>(far_ids_.size());
}

/// Moves the points nearer than `nearest_m` to the end of `near_`. The points before them are the
/// seen points, which may be in pixels.
void CloudEncoder::PutNearestLast(double nearest_m) {
  seen_ = near_.size();
  if (nearest_m <= 0) return;
  const auto square = static_cast<float>(nearest_m * nearest_m);
  std::vector<std::uint32_t> nearest;
  std::vector<std::uint32_t> others;
  others.reserve(near_.size());
  for (std::uint32_t i = 0; i < near_.size(); ++i) {
    const Point& p = near_[i];
    const bool is_near = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] < square;
    (is_near ? nearest : others).push_back(i);
  }
  if (nearest.empty()) return;
  seen_ = others.size();
  others.insert(others.end(), nearest.begin(), nearest.end());
  const auto reorder = [&](auto* values) {
    auto sorted = *values;
    for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = (*values)[others[i]];
    values->swap(sorted);
  };
  reorder(&near_);
  reorder(&near_ids_);
  reorder(&levels_);
}

void CloudEncoder::WriteFarPoints(const IntensityScale& scale,
                                  std::vector<std::uint8_t>* out) const {
  ByteWriter writer(out);
  for (const std::uint32_t i : far_ids_) {
    for (std::size_t k = 0; k < 3; ++k) writer.LeF32(cloud_.xyz[3 * std::size_t{i} + k]);
    if (scale.bits() > 0) writer.U8(scale.LevelOf(cloud_.intensity[i]));
  }
}

void CloudEncoder::CodeCells(const std::vector<Point>& points,
                             const std::vector<std::uint32_t>& ids, Cover cover,
                             Candidate* candidate) {
  const CloudHeader& header = candidate->header;
  cover(points, header.grid, header.depth, &covered_);
  candidate->cells.clear();
  mixing::BinaryEncoder encoder(&candidate->cells);
  tree_.Code(&covered_.cells, {points.size(), SIZE_MAX}, &encoder);
  std::vector<std::uint32_t>& points_in_order = candidate->cell_points;
  points_in_order.resize(covered_.order.size());
  for (std::size_t i = 0; i < points_in_order.size(); ++i)
    points_in_order[i] = ids[covered_.order[i]];
  if (!levels_.empty()) {
    const auto level_of = [&](std::uint32_t i) { return header.intensity.Coarsen(levels_[i]); };
    auto first = points_in_order.begin();
    for (const std::uint32_t count : covered_.cells.counts) {
      std::stable_sort(first, first + count,
                       [&](std::uint32_t a, std::uint32_t b) { return level_of(a) < level_of(b); });
      first += count;
    }
    std::vector<std::uint8_t> levels;
    for (const std::uint32_t i : points_in_order) levels.push_back(level_of(i));
    CodeLevels(covered_.cells, header.intensity.bits(), &levels, &encoder);
  }
  encoder.Finish();
  candidate->nodes = tree_.nodes();
}

/// Codes points as cells: those with the indices `ids` in `near_`. The highest effort also tries
/// each point's own cell, and keeps the smaller stream. This may be smaller because the counts vary
/// more if points share few cells.
void CloudEncoder::EncodeCells(const std::vector<std::uint32_t>& ids, Candidate* candidate) {
  candidate->header.points = static_cast<std::uint32_t>(ids.size());
  if (ids.empty()) return;
  std::vector<Point> points;
  points.reserve(ids.size());
  for (const std::uint32_t i : ids) points.push_back(near_[i]);
  constexpr std::array<Cover, EffortControl::kHighest + 1> kCovers = {
      CoverByOwnCells, CoverByMergedCells, CoverByFewCells, CoverByFewCells};
  const bool is_large = points.size() > kMostToChoose;
  CodeCells(points, ids, is_large ? CoverByOwnCells : kCovers[effort_], candidate);
  if (is_large || effort_ < EffortControl::kHighest) return;
  Candidate other;
  other.header = candidate->header;
  CodeCells(points, ids, CoverByOwnCells, &other);
  if (other.cells.size() >= candidate->cells.size()) return;
  candidate->cells.swap(other.cells);
  candidate->cell_points.swap(other.cell_points);
  candidate->nodes = other.nodes;
}

/// Codes the points by beams, and the points that fit no pixel as cells. Returns false if too few
/// of the points that are not too near are in pixels.
bool CloudEncoder::EncodeBeams(const BeamTable& table, const PixelErrors& errors, double nearest_m,
                               const RangeWay& way, Candidate* candidate) {
  if (!FillPixels({&sightings_, &placed_, &table}, errors, nearest_m, &pixels_)) return false;
  if (way.coder != RangeCoder::kMixing) pixels_.DropFewExtras();
  candidate->header.has_beams = true;
  const PointLevels levels{levels_.empty() ? nullptr : &levels_, candidate->header.intensity};
  for (std::size_t i = seen_; i < near_.size(); ++i)
    pixels_.rest.push_back(static_cast<std::uint32_t>(i));
  if (pixels_.returns < pixels_.asked / 4 ||
      !section_.Encode(table, errors, levels, way, &pixels_, &candidate->beams)) {
    return false;
  }
  EncodeCells(pixels_.rest, candidate);
  EncodeExact(&table, candidate);
  return true;
}

/// Returns the distance up to which points become cells, in multiples of the error. Returns 0 if
/// there are exact fields, because these cost more for points in cells than the cells save.
double CloudEncoder::ReachOf(const BeamTable& table) const {
  return choice_.empty() ? UsualReach(table) : 0;
}

/// Codes the exact fields of all points. If there is a `table`, the points in `pixels_` come first.
void CloudEncoder::EncodeExact(const BeamTable* table, Candidate* candidate) const {
  if (choice_.empty()) return;
  PointPlaces places;
  ExactPart part;
  const auto add = [&](std::uint32_t near, const PointPlace& place) {
    places.points.push_back(place);
    part.order.push_back(near_ids_[near]);
  };
  if (table != nullptr) {
    places.beams = table->rows();
    places.columns = table->columns();
    const RangeImage& image = pixels_.image;
    auto extra = pixels_.extras.begin();
    for (std::uint32_t i = 0; i < image.size(); ++i) {
      if (image.ranges[i] == 0) continue;
      const PointPlace place{i / image.columns, image.first_column + i % image.columns};
      add(pixels_.points[i], place);
      for (; extra != pixels_.extras.end() && extra->pixel == i; ++extra) add(extra->point, place);
    }
  }
  for (const std::uint32_t i : candidate->cell_points) add(i, {});
  for (const std::uint32_t i : far_ids_) {
    places.AddLoose(1);
    part.order.push_back(i);
  }
  for (const ExactField& field : exact_) {
    ExactField& sorted = part.fields.emplace_back();
    sorted.type = field.type;
    for (const std::uint32_t i : part.order) sorted.numbers.push_back(field.numbers[i]);
  }
  part.keeps_order = choice_.keeps_order;
  candidate->numbers = part.Numbers(part.order.size());
  candidate->header.has_exact_part = true;
  EncodeExactPart(places, part, &candidate->exact);
  candidate->order = std::move(part.order);
}

/// Codes the beams at each effort, and sets `best` to the smallest result. Near points become
/// cells, up to the distance that is cheapest at effort 1.
bool CloudEncoder::EncodeBeamsInAllWays(const BeamTable& table, const PixelErrors& errors,
                                        Candidate* best) {
  const unsigned effort = effort_;
  const CloudHeader header = best->header;
  bool found = false;
  const auto attempt = [&](unsigned lower, double reach) {
    Candidate candidate;
    candidate.header = header;
    effort_ = std::max(lower, 2U);  // so that cells are not merged, which would take more bits
    const bool coded = EncodeBeams(table, errors, reach * errors.error_m,
                                   {RangeCoder::kMixing, lower}, &candidate);
    effort_ = effort;
    if (!coded || (found && candidate.size() >= best->size())) return false;
    *best = std::move(candidate);
    found = true;
    return true;
  };
  double cheapest = ReachOf(table);
  for (const double part : kReaches) {
    const double reach = part * ReachOf(table);
    if ((part <= 0 || reach > 0) && attempt(1, reach)) cheapest = reach;
  }
  for (unsigned lower = 2; lower <= effort; ++lower) attempt(lower, cheapest);
  return found;
}

CloudEncoder::Candidate CloudEncoder::EncodeSmallest(const CloudHeader& header, double error_m) {
  Candidate best;
  best.header = header;
  bool found = false;
  const BeamTable* table = nullptr;
  const BeamTable* const last = effort_ < EffortControl::kHighest ? keeper_.table() : nullptr;
  PutNearestLast(last == nullptr ? 0 : ReachOf(*last) * error_m);
  if (near_.size() <= BeamKeeper::kMostPoints && seen_ > 0) {
    SightAll(near_, seen_, &sightings_);
    sighted_.clear();
    for (std::size_t i = 0; i < seen_ && !pulses_.empty(); ++i)
      sighted_.push_back(pulses_[near_ids_[i]]);
    table = keeper_.Place(sightings_, sighted_, near_, &placed_);
  }
  if (table != nullptr) {
    const PixelErrors errors = CheapestErrors({&sightings_, &placed_, table}, error_m);
    found = effort_ < EffortControl::kHighest
                ? EncodeBeams(*table, errors, ReachOf(*table) * error_m, WayOf(effort_), &best)
                : EncodeBeamsInAllWays(*table, errors, &best);
  }
  if (found && effort_ < EffortControl::kHighest) return best;
  Candidate cells;
  cells.header = header;
  std::vector<std::uint32_t> all(near_.size());
  std::iota(all.begin(), all.end(), 0U);
  EncodeCells(all, &cells);
  EncodeExact(nullptr, &cells);
  return found && best.size() <= cells.size() ? best : cells;
}

void CloudEncoder::Write(const Candidate& candidate, EncodedSlice* slice) const {
  CloudHeader header = candidate.header;
  header.stream_size = static_cast<std::uint32_t>(candidate.cells.size());
  header.Write(&slice->bytes);
  WriteFarPoints(header.intensity, &slice->bytes);
  for (const auto* part : {&candidate.beams, &candidate.cells})
    slice->bytes.insert(slice->bytes.end(), part->begin(), part->end());
  if (header.has_exact_part) {
    ByteWriter writer(&slice->bytes);
    WriteVarint(static_cast<std::uint32_t>(candidate.exact.size()), &writer);
    writer.Bytes({candidate.exact.data(), candidate.exact.size()});
  }
  const std::size_t work = std::max(candidate.nodes, candidate.numbers);
  while (work > MostNodes(slice->bytes.size())) slice->bytes.push_back(0);
}

bool CloudEncoder::HasComeBack(const ExactPart& decoded) const {
  if (decoded.fields.size() != exact_.size() || (choice_.keeps_order && decoded.order != order_)) {
    return false;
  }
  for (std::size_t k = 0; k < exact_.size(); ++k) {
    const std::vector<std::uint64_t>& numbers = decoded.fields[k].numbers;
    if (numbers.size() != order_.size()) return false;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (numbers[i] != exact_[k].numbers[order_[i]]) return false;
  }
  return true;
}

SliceResult CloudEncoder::Encode(const SliceSettings& settings, EncodedSlice* slice) {
  *slice = {};
  if (cloud_.size() == 0 || cloud_.size() > kMostPoints) return SliceResult::kEmpty;
  CloudHeader header;
  const double error_m = ErrorOf(settings);
  header.grid = CellGrid::ForError(error_m);
  if (header.grid.error_m() > settings.max_error_m) return SliceResult::kOutOfReach;
  header.intensity = ScaleOf(cloud_, settings.intensity_bits);
  SortOut(&header);
  Candidate candidate = EncodeSmallest(header, header.grid.error_m());
  Write(candidate, slice);
  order_ = std::move(candidate.order);
  slice->returns = cloud_.size();
  slice->step_m = static_cast<double>(header.grid.step_m);
  slice->error_m = header.grid.error_m();
  return SliceResult::kEncoded;
}

}  // namespace lidar::codec::cloud
