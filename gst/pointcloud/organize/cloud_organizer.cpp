// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/organize/cloud_organizer.h"

#include <cmath>
#include <cstring>

#include "src/cloud/point_math.h"

namespace lidar::gst {
namespace {

constexpr guint kRangeSize = 4;
constexpr guint64 kCloudsBetweenFits = 10;  // where single points stand elsewhere

/// The fields of `info` but range, then a range U32 at `range_offset`.
std::optional<PointFields> WithRange(const CloudInfo& info, guint range_offset) {
  std::string text;
  for (const PointField& f : info.fields.all()) {
    if (f.name == "range") continue;
    PointFields one;
    one.Add(f.name, f.type);
    const std::string at_0 = one.ToString();  // name:type:0
    text += at_0.substr(0, at_0.size() - 1) + std::to_string(f.offset) + ",";
  }
  return PointFields::Parse(text + "range:U32:" + std::to_string(range_offset));
}

}  // namespace

std::optional<CloudOrganizer> CloudOrganizer::Create(const CloudInfo& info, std::string* why) {
  if (info.height < 2 || info.width < 2) {
    *why = "it has no rows of beams (height=" + std::to_string(info.height) + ")";
    return std::nullopt;
  }
  if (info.height > SensorModel::kMaxBeams) {
    *why = "it has more than " + std::to_string(SensorModel::kMaxBeams) + " rows";
    return std::nullopt;
  }
  if (!info.fields.HasPackedXyz()) {
    *why = "x, y and z are not F32 side by side";
    return std::nullopt;
  }
  CloudOrganizer organizer(info);
  const bool has_range = info.fields.Has("range", FieldType::kU32);
  organizer.xyz_offset_ = info.fields.Find("x")->offset;
  organizer.range_offset_ = has_range ? info.fields.Find("range")->offset : info.point_step;
  organizer.output_ = info;
  organizer.output_.is_dense = false;
  organizer.output_.point_step += has_range ? 0 : kRangeSize;
  const auto fields = WithRange(info, organizer.range_offset_);
  if (!fields || organizer.output_.point_step > PointFields::kMaxPointStep) {
    *why = "there is no room for a range";
    return std::nullopt;
  }
  organizer.output_.fields = *fields;
  return organizer;
}

CloudOrganizer::Result CloudOrganizer::Write(ByteView cloud, const RangeProjection& projection,
                                             gdouble max_error_m, guint8* out) const {
  Result result;
  const double worst = max_error_m * max_error_m;
  const guint8* in = cloud.data;
  for (guint beam = 0; beam < input_.height; ++beam) {
    for (guint column = 0; column < input_.width; ++column) {
      const auto p = PositionAt(in + xyz_offset_);
      std::array<float, 3> q{};
      std::uint32_t range = 0;
      if (IsReturn(p)) {
        const double mm = projection.RangeOf(beam, column, p.data());
        if (mm >= 1 && mm < G_MAXINT32) range = static_cast<std::uint32_t>(std::lround(mm));
        q = projection.Point(beam, column, range);
        ++result.returns;
        if (range == 0 || !(SquaredDistance(p.data(), q.data()) <= worst)) {
          ++result.outside;
          range = 0;
          q = {};
        }
      }
      std::memcpy(out, in, input_.point_step);
      std::memcpy(out + xyz_offset_, q.data(), sizeof q);
      std::memcpy(out + range_offset_, &range, sizeof range);
      in += input_.point_step;
      out += output_.point_step;
    }
  }
  return result;
}

std::optional<CloudOrganizer::Result> CloudOrganizer::Organize(ByteView cloud, gdouble max_error_m,
                                                               guint8* out) {
  ++clouds_since_fit_;
  std::optional<Result> before;
  if (projection_) {
    before = Write(cloud, *projection_, max_error_m, out);
    // A beam that had seen nothing stands elsewhere than guessed: that is worth another fit.
    if (before->outside == 0 || (before->fits() && clouds_since_fit_ < kCloudsBetweenFits))
      return before;
  }
  clouds_since_fit_ = 0;
  fit_.Add(cloud.data + xyz_offset_, input_.point_step);
  if (const auto model = fit_.Fit()) {
    RangeProjection projection(*model);
    const Result result = Write(cloud, projection, max_error_m, out);
    if (result.fits() && (!before || result.outside < before->outside)) {
      output_.sensor_model = *model;
      projection_ = std::move(projection);
      ++models_;
      return result;
    }
  }
  if (before && before->fits()) return Write(cloud, *projection_, max_error_m, out);
  fit_ = BeamFit(input_.width, input_.height);  // what did not fit must not spoil the next attempt
  return std::nullopt;
}

}  // namespace lidar::gst
