// SPDX-License-Identifier: LGPL-2.1-or-later
// The part of the renderer that draws scans on the map.
#include <algorithm>
#include <cmath>

#include "gst/view/palette.h"
#include "gst/view/renderer.h"

namespace lidar::gst {
namespace {

constexpr Color kBackground{20, 23, 32};
constexpr Color kWay{255, 176, 46};
constexpr Color kSensor{255, 255, 255};
constexpr float kMapShare = 0.7F;  // a point of the map keeps this share of its colour
constexpr float kReach = 300;      // distance up to which the map is drawn in perspective [m]
// The number of scans that must have seen a point of the map before it is drawn. Most moving
// objects are seen less often, and are therefore not drawn.
constexpr int kMetOften = 3;
constexpr float kMargin = 25;  // around the sensor's route [m]
/// The number of poses per slice. Each group of columns is placed by one of them.
constexpr std::size_t kPhases = 64;

}  // namespace

/// Sets the view of the map. The view from above shows the whole route, with x to the right. In
/// perspective, the picture turns with the sensor, but does not tilt with it.
void Renderer::FrameMap() {
  const Rigid pose = map_->PoseAfter(0);
  middle_ = pose.position;
  if (settings_.view == ViewKind::kPerspective) {
    cos_turn_ = std::cos(pose.heading());
    sin_turn_ = std::sin(pose.heading());
    return;
  }
  std::array<float, 2> low{middle_[0], middle_[1]};
  std::array<float, 2> high = low;
  for (const auto& place : map_->way()) {
    for (std::size_t i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], place[i]);
      high[i] = std::max(high[i], place[i]);
    }
  }
  for (std::size_t i = 0; i < 2; ++i) middle_[i] = (low[i] + high[i]) / 2;
  const auto width = static_cast<float>(canvas_.width());
  const auto height = static_cast<float>(canvas_.height());
  const float needed =
      std::max(high[0] - low[0] + 2 * kMargin, (high[1] - low[1] + 2 * kMargin) * width / height);
  pixels_per_m_ = width / std::max(settings_.extent_m, needed);
}

Renderer::Vec Renderer::ToPicture(const std::array<float, 3>& at) const {
  const float x = at[0] - middle_[0];
  const float y = at[1] - middle_[1];
  return {cos_turn_ * x + sin_turn_ * y, cos_turn_ * y - sin_turn_ * x, at[2] - middle_[2]};
}

void Renderer::DrawOverMap(const CloudInfo& info, const GstLidarSlice& slice,
                           const std::uint8_t* points, bool into_map) {
  // Columns have known times only in an organised cloud.
  const GstClockTime period = info.height > 1 ? info.ScanDuration() : GST_CLOCK_TIME_NONE;
  const double sweep_s = GST_CLOCK_TIME_IS_VALID(period)
                             ? static_cast<double>(period) / GST_SECOND /
                                   static_cast<double>(std::max(1U, slice.slice_count))
                             : 0;
  std::array<Rigid, kPhases> poses;
  for (std::size_t i = 0; i < kPhases; ++i)
    poses[i] = map_->PoseAfter(sweep_s * static_cast<double>(i) / kPhases);
  ForEachPoint(info, points, [&](const Point& point) {
    const std::size_t phase = info.height > 1 ? point.column * kPhases / info.width : 0;
    const auto at = poses[phase](point.p.x, point.p.y, point.p.z);
    if (into_map) map_->Add(at, point.value);
    Point placed = point;
    placed.p = ToPicture(at);
    if (settings_.view == ViewKind::kTop) {
      PlotTop(placed);
    } else {
      PlotPerspective(placed);
    }
  });
}

void Renderer::DrawMap() {
  const bool top = settings_.view == ViewKind::kTop;
  // A point is drawn as large as its cube appears in the picture.
  const float cube = map_->cube_m();
  for (const TrailMap::Point& point : map_->points()) {
    if (point.scans < kMetOften) continue;
    const Vec p = ToPicture(point.at);
    if (!top && !(std::abs(p.x) < kReach && std::abs(p.y) < kReach)) continue;
    const auto at = Place(p);
    if (!at) continue;
    const float pixels = top ? pixels_per_m_ * cube : focal_ * cube * 1.1F / (*at)[2];
    const int size = settings_.point_size > 0 ? settings_.point_size
                                              : std::clamp(static_cast<int>(pixels + 0.5F), 1, 8);
    // The depth of the map is increased, so that the points of the last scan hide the map.
    const float depth = (*at)[2] + cube;
    canvas_.Splat(static_cast<int>((*at)[0]), static_cast<int>((*at)[1]), size, depth,
                  Mix(kBackground, ColorOf(point.value), kMapShare));
  }
}

void Renderer::DrawWay() {
  const bool top = settings_.view == ViewKind::kTop;
  const int width = std::max(2, canvas_.width() / 320);
  // The route is drawn over everything in the view from above. In perspective, it is on the ground.
  const auto end = [&](const std::array<float, 3>& place) -> std::optional<Canvas::End> {
    Vec p = ToPicture(place);
    p.z += kGround + 0.3F;
    const auto at = Place(p);
    if (!at) return std::nullopt;
    return Canvas::End{(*at)[0], (*at)[1], top ? 0.5F : (*at)[2] - 0.5F};
  };
  std::optional<Canvas::End> last;
  for (const auto& place : map_->way()) {
    const auto next = end(place);
    if (last && next) canvas_.Stroke(*last, *next, width, kWay);
    last = next;
  }
  const auto here = end(map_->PoseAfter(0).position);
  if (last && here) canvas_.Stroke(*last, *here, width, kWay);
  if (here)
    canvas_.Splat(static_cast<int>(here->x), static_cast<int>(here->y), 3 * width, here->depth / 2,
                  kSensor);
}

}  // namespace lidar::gst
