// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/odometry/scan_collector.h"

#include <algorithm>
#include <array>
#include <utility>

#include "src/cloud/field_number.h"
#include "src/cloud/point_math.h"

namespace lidar::gst {
namespace {

constexpr Duration kUsualScan = std::chrono::milliseconds(100);
constexpr Duration kLongestScan = odometry::Odometry::kLongestGap;
/// Limits the memory in case a scan does not end. Scans of real sensors are smaller.
constexpr std::size_t kMaxPoints = std::size_t{1} << 22;

}  // namespace

bool ScanCollector::SetInfo(const CloudInfo& info) {
  info_ = info;
  const auto copied = [](const PointField* field) {
    return field != nullptr ? std::optional(*field) : std::nullopt;
  };
  time_ = copied(TimeFieldOf(info.fields));
  const PointField* ring = info.fields.Find("ring");
  ring_ = copied(ring != nullptr ? ring : info.fields.Find("channel"));
  if (ring_ && ring_->type != FieldType::kU8 && ring_->type != FieldType::kU16) ring_.reset();
  return info.fields.HasPackedXyz();
}

bool ScanCollector::BeginsNewScan(const GstLidarSlice& slice) const {
  return open_ && (slice.scan_id != scan_id_ || slice.slice_index < next_index_ ||
                   scan_.points.points.size() >= kMaxPoints);
}

void ScanCollector::Open(const GstLidarSlice& slice, Time time) {
  const GstClockTime period = info_.ScanDuration();
  scan_.points = {};
  scan_.duration = GST_CLOCK_TIME_IS_VALID(period)
                       ? std::min(Duration{static_cast<std::int64_t>(period)}, kLongestScan)
                       : kUsualScan;
  // If the first slices are missing, the scan began before `time`.
  scan_.start = time - scan_.duration * slice.slice_index / slice.slice_count;
  scan_id_ = slice.scan_id;
  open_ = true;
}

void ScanCollector::Add(const GstLidarSlice& slice, Time time, const guint8* points, gsize size) {
  if (!open_) Open(slice, time);
  next_index_ = slice.slice_index + 1;
  count_ = slice.slice_count;
  const PointsInMemory memory{points, size / info_.point_step, info_.point_step,
                              info_.fields.Find("x")->offset};
  const std::vector<float> phases = PhasesOf(slice, memory);
  const gsize width = memory.count / info_.height;
  const bool organised = info_.height > 1 && width > 0;
  scan_.points.points.reserve(scan_.points.points.size() + memory.count);
  for (gsize i = 0; i < memory.count; ++i) {
    const guint8* point = points + i * memory.step;
    const std::array<float, 3> p = PositionAt(point + memory.xyz_offset);
    if (p[0] == 0 && p[1] == 0 && p[2] == 0) continue;  // a missing return
    scan_.points.points.push_back(Eigen::Vector3f(p[0], p[1], p[2]).cast<double>());
    if (organised)
      scan_.points.rings.push_back(static_cast<std::uint16_t>(i / width));
    else if (ring_)
      scan_.points.rings.push_back(
          static_cast<std::uint16_t>(ReadNumber(point + ring_->offset, ring_->type, false)));
    if (!phases.empty()) scan_.points.phases.push_back(phases[i]);
  }
}

/// Returns the phases of the points in a slice. They come from the time field, or else from the
/// columns, or else from the slice index. Returns an empty vector if all of these are missing.
std::vector<float> ScanCollector::PhasesOf(const GstLidarSlice& slice,
                                           const PointsInMemory& points) const {
  const auto slices = static_cast<float>(slice.slice_count);
  const float first = static_cast<float>(slice.slice_index) / slices;
  const auto scan_s = std::chrono::duration<double>(scan_.duration).count();
  if (time_) {
    std::vector<float> phases = SecondsOf(*time_, points, scan_s / slice.slice_count);
    for (float& phase : phases) phase = first + phase / static_cast<float>(scan_s);
    if (!phases.empty()) return phases;
  }
  const gsize width = points.count / info_.height;
  const bool organised = info_.height > 1 && width > 0;
  if (!organised && slice.slice_count == 1) return {};
  std::vector<float> phases(points.count, first);
  if (!organised) return phases;
  const float per_column = 1 / (static_cast<float>(width) * slices);
  for (gsize i = 0; i < points.count; ++i) phases[i] += static_cast<float>(i % width) * per_column;
  return phases;
}

std::optional<CollectedScan> ScanCollector::Take() {
  next_index_ = 0;
  if (!std::exchange(open_, false)) return std::nullopt;
  return std::move(scan_);
}

}  // namespace lidar::gst
