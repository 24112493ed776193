// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/enc_error_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "ext/draco/draco_check.h"
#include "ext/draco/enc_nearest.h"
#include "src/codec/point_math.h"

namespace lidar::gst {
namespace {

constexpr std::size_t kDecodedStep = 16;  // x, y, z, range

codec::CloudLayout DecodedLayout() {
  return {*PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,range:U32:12"), kDecodedStep};
}

using Point = std::array<float, 3>;

Point PointAt(const std::uint8_t* bytes) {
  Point p;
  std::memcpy(p.data(), bytes, sizeof p);
  return p;
}

bool IsFinite(const Point& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

double Distance(const float* a, const float* b) { return std::sqrt(codec::SquaredDistance(a, b)); }

/// Collects distances.
class Distances {
 public:
  void Add(double metres) {
    ++errors_.points;
    sum_ += metres;
    errors_.max_m = std::max(errors_.max_m, metres);
  }
  /// Of a decoded point for which no other one stands.
  void AddBack(double metres) { errors_.max_m = std::max(errors_.max_m, metres); }
  void AddMissing(std::uint64_t points) { errors_.missing += points; }
  /// Both positions of a distance are rounded, and each in three coordinates.
  void OnCoordinate(double metres) { largest_ = std::max(largest_, std::abs(metres)); }
  PointErrors Take() {
    if (errors_.points > 0) errors_.mean_m = sum_ / static_cast<double>(errors_.points);
    errors_.rounding_m = 4 * static_cast<double>(std::numeric_limits<float>::epsilon()) * largest_;
    return errors_;
  }

 private:
  PointErrors errors_;
  double sum_ = 0;
  double largest_ = 0;
};

}  // namespace

ErrorCheck::ErrorCheck(const codec::CloudFormat& format, Geometry geometry)
    : input_(format), geometry_(geometry) {}

std::optional<PointErrors> ErrorCheck::Measure(ByteView raw,
                                               const std::vector<std::uint8_t>& slice) {
  const std::size_t most = raw.size / input_.layout.point_step;
  if (most > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  codec::CloudFormat format = input_;
  format.layout = DecodedLayout();
  const auto max_points = static_cast<std::uint32_t>(most);
  draco::SliceDecoder decoder(format, geometry_, max_points);
  const ByteView bytes{slice.data(), slice.size()};
  const auto shape = decoder.Decode(bytes);
  if (!shape) return std::nullopt;
  const std::size_t points = std::size_t{shape->width} * shape->height;
  decoded_.resize(points * kDecodedStep);
  decoder.Write(decoded_.data());
  if (geometry_ == Geometry::kRange)
    return points == most ? std::optional(ComparePixels(raw)) : std::nullopt;
  const auto summary = draco::CheckDraco(bytes, max_points);
  return CompareClouds(raw, summary && !summary->is_kd_tree);
}

PointErrors ErrorCheck::ComparePixels(ByteView raw) const {
  const bool has_xyz = input_.layout.fields.HasPackedXyz();
  const std::size_t range_offset = input_.layout.fields.Find("range")->offset;
  const std::size_t xyz_offset = has_xyz ? input_.layout.fields.Find("x")->offset : 0;
  const std::uint8_t* before = raw.data;
  Distances distances;
  for (std::size_t at = 0; at < decoded_.size();
       at += kDecodedStep, before += input_.layout.point_step) {
    const std::uint32_t range = codec::RangeAt(before + range_offset);
    const std::uint32_t decoded_range = codec::RangeAt(&decoded_[at + 12]);
    if ((range > 0) != (decoded_range > 0)) distances.AddMissing(1);
    if (range == 0 || decoded_range == 0) continue;
    const double decoded_m = 1e-3 * decoded_range;
    distances.OnCoordinate(decoded_m);
    const Point p = has_xyz ? PointAt(before + xyz_offset) : Point{};
    if (!has_xyz) {
      distances.Add(std::abs(1e-3 * range - decoded_m));
    } else if (IsFinite(p)) {
      distances.Add(Distance(p.data(), PointAt(&decoded_[at]).data()));
    }
  }
  return distances.Take();
}

PointErrors ErrorCheck::CompareClouds(ByteView raw, bool in_order) const {
  codec::XyzCloud before;
  codec::ReadXyz(raw, input_.layout, false, &before);
  std::vector<float> after;
  after.reserve(decoded_.size() / kDecodedStep * 3);
  for (std::size_t at = 0; at < decoded_.size(); at += kDecodedStep) {
    const Point p = PointAt(&decoded_[at]);
    after.insert(after.end(), p.begin(), p.end());
  }
  Distances distances;
  for (const float coordinate : before.xyz) distances.OnCoordinate(static_cast<double>(coordinate));
  const std::size_t sent = after.size() / 3;
  const std::size_t missing = before.size() - std::min(before.size(), sent);
  distances.AddMissing(missing);
  if (in_order && missing == 0) {
    for (std::size_t i = 0; i < after.size(); i += 3)
      distances.Add(Distance(&before.xyz[i], &after[i]));
    return distances.Take();
  }
  const NearestPoint original(before.xyz);
  for (std::size_t i = 0; i < after.size(); i += 3) {
    const double distance = original.DistanceFrom(&after[i]);
    // Where points were left out, no point that is there stands for them.
    missing > 0 ? distances.Add(distance) : distances.AddBack(distance);
  }
  if (missing > 0) return distances.Take();
  const NearestPoint decoded(after);
  for (std::size_t i = 0; i < before.xyz.size(); i += 3)
    distances.Add(decoded.DistanceFrom(&before.xyz[i]));
  return distances.Take();
}

}  // namespace lidar::gst
