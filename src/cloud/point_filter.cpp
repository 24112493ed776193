// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/point_filter.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <locale>
#include <sstream>

#include "src/cloud/point_math.h"

namespace lidar {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

Transform FromAngles(const std::vector<double>& v) {
  const double sr = std::sin(v[3] * kDegree), cr = std::cos(v[3] * kDegree);
  const double sp = std::sin(v[4] * kDegree), cp = std::cos(v[4] * kDegree);
  const double sy = std::sin(v[5] * kDegree), cy = std::cos(v[5] * kDegree);
  return {cy * cp,
          cy * sp * sr - sy * cr,
          cy * sp * cr + sy * sr,
          v[0],
          sy * cp,
          sy * sp * sr + cy * cr,
          sy * sp * cr - cy * sr,
          v[1],
          -sp,
          cp * sr,
          cp * cr,
          v[2],
          0,
          0,
          0,
          1};
}

std::array<float, 3> Moved(const Transform& t, const std::array<float, 3>& p) {
  std::array<float, 3> moved{};
  for (std::size_t row = 0; row < 3; ++row) {
    double sum = t[4 * row + 3];
    for (std::size_t i = 0; i < 3; ++i) sum += t[4 * row + i] * static_cast<double>(p[i]);
    moved[row] = static_cast<float>(sum);
  }
  return moved;
}

}  // namespace

std::optional<std::vector<double>> ParseNumbers(const std::string& text) {
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::istringstream in(spaced);
  in.imbue(std::locale::classic());
  std::vector<double> numbers;
  for (std::string word; in >> word;) {
    std::istringstream one(word);
    one.imbue(std::locale::classic());
    double value = 0;
    if (!(one >> value) || one.peek() != std::char_traits<char>::eof() || !std::isfinite(value))
      return std::nullopt;
    numbers.push_back(value);
  }
  return numbers;
}

std::optional<Transform> ParseTransform(const std::string& text) {
  const auto numbers = ParseNumbers(text);
  if (!numbers) return std::nullopt;
  if (numbers->size() == 6) return FromAngles(*numbers);
  if (numbers->size() != 16) return std::nullopt;
  Transform transform{};
  std::copy(numbers->begin(), numbers->end(), transform.begin());
  return transform;
}

Transform FromPose(const std::array<double, 3>& p, const std::array<double, 4>& q) {
  const auto [x, y, z, w] = q;
  return {1 - 2 * (y * y + z * z),
          2 * (x * y - z * w),
          2 * (x * z + y * w),
          p[0],
          2 * (x * y + z * w),
          1 - 2 * (x * x + z * z),
          2 * (y * z - x * w),
          p[1],
          2 * (x * z - y * w),
          2 * (y * z + x * w),
          1 - 2 * (x * x + y * y),
          p[2],
          0,
          0,
          0,
          1};
}

std::optional<PointFilter> PointFilter::Make(const PointFilterSettings& settings,
                                             const PointFields& fields, std::uint32_t point_step) {
  const bool has_xyz = fields.HasPackedXyz();
  if (settings.needs_xyz() && !has_xyz) return std::nullopt;
  return PointFilter(settings, has_xyz ? fields.Find("x")->offset : 0, point_step);
}

bool PointFilter::IsFirstInVoxel(const std::array<float, 3>& xyz) {
  std::uint64_t key = 0;
  for (const float c : xyz) {
    // There are 2^21 cubes along each axis. Points outside of all cubes count as in the outermost
    // cubes.
    const double index = std::floor(static_cast<double>(c) / settings_.voxel_size_m);
    const auto limited = static_cast<std::int64_t>(std::clamp(index, -1048576.0, 1048575.0));
    key = key << 21 | static_cast<std::uint64_t>(limited + 1048576);
  }
  return voxels_.insert(key).second;
}

/// Moves the point by the pose and the transform. Returns false if the point must be removed.
bool PointFilter::Keeps(std::array<float, 3>* xyz) {
  const PointFilterSettings& s = settings_;
  const auto square = [](float v) { return static_cast<double>(v) * static_cast<double>(v); };
  const double range = square((*xyz)[0]) + square((*xyz)[1]) + square((*xyz)[2]);
  if (range < s.min_range_m * s.min_range_m) return false;
  if (s.max_range_m > 0 && range > s.max_range_m * s.max_range_m) return false;
  if (s.has_pose) *xyz = Moved(pose_, *xyz);
  if (s.transform) *xyz = Moved(*s.transform, *xyz);
  if (!IsFinite(*xyz)) return false;
  if (s.crop_box) {
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto c = static_cast<double>((*xyz)[i]);
      inside = inside && c >= (*s.crop_box)[i] && c <= (*s.crop_box)[i + 3];
    }
    if (inside == s.crop_inside) return false;
  }
  return s.voxel_size_m <= 0 || IsFirstInVoxel(*xyz);
}

void PointFilter::Take(const std::uint8_t* point, std::vector<std::uint8_t>* out) {
  std::array<float, 3> xyz = PositionAt(point + xyz_);
  const bool is_return = IsReturn(xyz);
  const bool kept = is_return && Keeps(&xyz);
  if (is_return && !kept) ++removed_;
  if (!kept && settings_.invalid == InvalidPoints::kRemove) return;
  const std::size_t at = out->size();
  if (kept || (!is_return && settings_.invalid == InvalidPoints::kKeep))
    out->insert(out->end(), point, point + point_step_);
  else
    out->resize(at + point_step_, 0);
  if (!kept && settings_.invalid == InvalidPoints::kNan)
    xyz.fill(std::numeric_limits<float>::quiet_NaN());
  else if (!kept)
    return;
  std::memcpy(out->data() + at + xyz_, xyz.data(), sizeof xyz);
}

FilteredCloud PointFilter::Apply(const CloudRows& cloud) {
  FilteredCloud out;
  const std::uint32_t step = settings_.column_step;
  const std::uint32_t skipped = (step - cloud.first_column % step) % step;
  const std::uint32_t rows = (cloud.height + settings_.beam_step - 1) / settings_.beam_step;
  const std::uint32_t columns = cloud.width > skipped ? (cloud.width - skipped - 1) / step + 1 : 0;
  out.first_column = (cloud.first_column + skipped) / step;
  out.points.reserve(std::size_t{rows} * columns * point_step_);
  voxels_.clear();
  pose_ = cloud.pose;
  for (std::uint32_t row = 0; row < rows; ++row) {
    const std::size_t first = std::size_t{row} * settings_.beam_step * cloud.width + skipped;
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint8_t* point = cloud.points + (first + std::size_t{column} * step) * point_step_;
      if (settings_.needs_xyz())
        Take(point, &out.points);
      else
        out.points.insert(out.points.end(), point, point + point_step_);
    }
  }
  out.width = columns;
  out.height = rows;
  if (settings_.invalid == InvalidPoints::kRemove) {
    out.width = static_cast<std::uint32_t>(out.points.size() / point_step_);
    out.height = 1;
  }
  return out;
}

}  // namespace lidar
