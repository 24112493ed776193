// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/odometry/scan_collector.h"

#include <array>
#include <cstring>
#include <utility>

namespace lidar::gst {
namespace {

constexpr Duration kUsualScan = std::chrono::milliseconds(100);
/// No sensor's scan has more: a stream of endless slices shall not fill the memory.
constexpr std::size_t kMaxPoints = std::size_t{1} << 22;

}  // namespace

bool ScanCollector::SetInfo(const CloudInfo& info) {
  info_ = info;
  return info.fields.HasPackedXyz();
}

bool ScanCollector::BeginsNewScan(const GstLidarSlice& slice) const {
  return open_ && (slice.scan_id != scan_id_ || slice.slice_index < next_index_ ||
                   scan_.points.points.size() >= kMaxPoints);
}

void ScanCollector::Open(const GstLidarSlice& slice, Time time) {
  const GstClockTime period = info_.ScanDuration();
  scan_.points = {};
  scan_.duration =
      GST_CLOCK_TIME_IS_VALID(period) ? Duration{static_cast<std::int64_t>(period)} : kUsualScan;
  // A scan whose first slices are missing began before.
  scan_.start = time - scan_.duration * slice.slice_index / slice.slice_count;
  scan_id_ = slice.scan_id;
  open_ = true;
}

void ScanCollector::Add(const GstLidarSlice& slice, Time time, const guint8* points, gsize size) {
  if (!open_) Open(slice, time);
  next_index_ = slice.slice_index + 1;
  count_ = slice.slice_count;
  const gsize count = size / info_.point_step;
  const gsize width = count / info_.height;
  // Only an organised cloud tells in which column a point was sampled.
  const bool organised = info_.height > 1 && width > 0;
  const bool timed = organised || slice.slice_count > 1;
  const auto slices = static_cast<float>(slice.slice_count);
  const float first = static_cast<float>(slice.slice_index) / slices;
  const float per_column = organised ? 1 / (static_cast<float>(width) * slices) : 0;
  const guint32 offset = info_.fields.Find("x")->offset;
  scan_.points.points.reserve(scan_.points.points.size() + count);
  for (gsize i = 0; i < count; ++i) {
    std::array<float, 3> p;
    std::memcpy(p.data(), points + i * info_.point_step + offset, sizeof p);
    if (p[0] == 0 && p[1] == 0 && p[2] == 0) continue;  // no return
    scan_.points.points.push_back(Eigen::Vector3f(p[0], p[1], p[2]).cast<double>());
    if (organised) scan_.points.rings.push_back(static_cast<std::uint16_t>(i / width));
    if (!timed) continue;
    const float column = organised ? static_cast<float>(i % width) : 0;
    scan_.points.phases.push_back(first + column * per_column);
  }
}

std::optional<CollectedScan> ScanCollector::Take() {
  next_index_ = 0;
  if (!std::exchange(open_, false)) return std::nullopt;
  return std::move(scan_);
}

}  // namespace lidar::gst
