// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/cloud_encoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/base/byte_writer.h"
#include "src/codec/cloud/level_tree.h"
#include "src/codec/effort_control.h"
#include "src/codec/mixing/binary_coder.h"

namespace lidar::codec::cloud {
namespace {

/// Choosing cells takes some 100 bytes a point.
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

}  // namespace

std::optional<CloudEncoder> CloudEncoder::Create(const CloudLayout& layout) {
  if (!layout.fields.HasPackedXyz()) return std::nullopt;
  return CloudEncoder(layout);
}

void CloudEncoder::Load(ByteView raw, bool with_intensity) {
  ReadXyz(raw, layout_, with_intensity && HasIntensity(layout_.fields), &cloud_);
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
  XyzCloud thinned;
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (!kept[i]) continue;
    thinned.xyz.insert(thinned.xyz.end(), &cloud_.xyz[3 * i], &cloud_.xyz[3 * i] + 3);
    if (!cloud_.intensity.empty()) thinned.intensity.push_back(cloud_.intensity[i]);
  }
  cloud_ = std::move(thinned);
}

/// Parts points that the grid can hold from those that are too far away.
void CloudEncoder::SortOut(const CellGrid& grid, unsigned* depth) {
  near_.clear();
  near_ids_.clear();
  far_ids_.clear();
  *depth = 1;
  for (std::uint32_t i = 0; i < cloud_.size(); ++i) {
    const Point point = {cloud_.xyz[3 * i], cloud_.xyz[3 * i + 1], cloud_.xyz[3 * i + 2]};
    float farthest = 0;
    for (const float v : point) farthest = std::max(farthest, std::abs(v));
    const unsigned needed = grid.DepthFor(static_cast<double>(farthest));
    if (needed > kMostDepth || !grid.Holds(point)) {
      far_ids_.push_back(i);
      continue;
    }
    *depth = std::max(*depth, needed);
    near_.push_back(point);
    near_ids_.push_back(i);
  }
}

void CloudEncoder::WriteFarPoints(const IntensityScale& scale,
                                  std::vector<std::uint8_t>* out) const {
  ByteWriter writer(out);
  for (const std::uint32_t i : far_ids_) {
    for (std::size_t k = 0; k < 3; ++k) writer.LeF32(cloud_.xyz[3 * std::size_t{i} + k]);
    if (scale.bits() > 0) writer.U8(scale.LevelOf(cloud_.intensity[i]));
  }
}

/// Cell by cell, rising within each.
std::vector<std::uint8_t> CloudEncoder::LevelsOf(const IntensityScale& scale) {
  std::vector<std::uint8_t> levels;
  for (const std::uint32_t i : covered_.order)
    levels.push_back(scale.LevelOf(cloud_.intensity[near_ids_[i]]));
  auto first = levels.begin();
  for (const std::uint32_t count : covered_.cells.counts) {
    std::sort(first, first + count);
    first += count;
  }
  return levels;
}

/// Returns how many nodes the tree has.
std::size_t CloudEncoder::EncodeCells(const CloudHeader& header, bool few,
                                      std::vector<std::uint8_t>* out) {
  out->clear();
  (few ? CoverByFewCells : CoverByOwnCells)(near_, header.grid, header.depth, &covered_);
  mixing::BinaryEncoder encoder(out);
  tree_.Code(&covered_.cells, {near_.size(), SIZE_MAX}, &encoder);
  if (header.intensity.bits() > 0) {
    auto levels = LevelsOf(header.intensity);
    CodeLevels(covered_.cells, header.intensity.bits(), &levels, &encoder);
  }
  encoder.Finish();
  return tree_.nodes();
}

/// Fewer cells have more various counts: which is smaller depends on the cloud.
std::size_t CloudEncoder::EncodeSmallest(const CloudHeader& header) {
  stream_.clear();
  if (near_.empty()) return 0;
  const bool few = effort_ > 0 && near_.size() <= kMostToChoose;
  const std::size_t nodes = EncodeCells(header, few, &stream_);
  if (!few || effort_ < EffortControl::kHighest) return nodes;
  std::vector<std::uint8_t> other;
  const std::size_t other_nodes = EncodeCells(header, false, &other);
  if (other.size() >= stream_.size()) return nodes;
  stream_.swap(other);
  return other_nodes;
}

SliceResult CloudEncoder::Encode(const SliceSettings& settings, EncodedSlice* slice) {
  *slice = {};
  if (cloud_.size() == 0 || cloud_.size() > kMostPoints) return SliceResult::kEmpty;
  CloudHeader header;
  header.grid = CellGrid::ForError(ErrorOf(settings));
  if (header.grid.error_m() > settings.max_error_m) return SliceResult::kOutOfReach;
  header.intensity = ScaleOf(cloud_, settings.intensity_bits);
  SortOut(header.grid, &header.depth);
  header.points = static_cast<std::uint32_t>(near_.size());
  header.far_points = static_cast<std::uint32_t>(far_ids_.size());
  const std::size_t nodes = EncodeSmallest(header);
  header.stream_size = static_cast<std::uint32_t>(stream_.size());
  header.Write(&slice->bytes);
  WriteFarPoints(header.intensity, &slice->bytes);
  slice->bytes.insert(slice->bytes.end(), stream_.begin(), stream_.end());
  while (nodes > MostNodes(slice->bytes.size())) slice->bytes.push_back(0);
  slice->returns = cloud_.size();
  slice->step_m = static_cast<double>(header.grid.step_m);
  slice->error_m = header.grid.error_m();
  return SliceResult::kEncoded;
}

}  // namespace lidar::codec::cloud
