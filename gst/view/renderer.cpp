// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/view/renderer.h"

#include <algorithm>
#include <cmath>

#include "gst/view/palette.h"

namespace lidar::gst {
namespace {

constexpr float kPi = 3.14159265F;
constexpr Color kRing{120, 132, 158};
constexpr Color kCar{255, 255, 255};
constexpr float kAbove = 100;  // height of the camera in the view from above [m]

struct Scale {
  float low, high;
};

/// Returns the default range of values for the colours.
Scale DefaultScale(ColorBy by, guint beams) {
  switch (by) {
    case ColorBy::kHeight:
      return {-2.0F, 7.0F};
    case ColorBy::kRange:
      return {0, 60};
    case ColorBy::kRing:
      return {0, static_cast<float>(std::max(1U, beams - 1))};
    case ColorBy::kIntensity:
      break;
  }
  return {0, 100};
}

}  // namespace

Renderer::Renderer(const ViewSettings& settings, int width, int height, TrailMap* map)
    : settings_(settings),
      canvas_(width, height),
      pixels_per_m_(static_cast<float>(width) / settings.extent_m),
      map_(settings.view == ViewKind::kRange ? nullptr : map) {
  const auto& e = settings.eye_m;
  const auto& t = settings.target_m;
  const auto unit = [](Vec v) {
    const float n = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return n > 0 ? Vec{v.x / n, v.y / n, v.z / n} : Vec{1, 0, 0};
  };
  const auto cross = [](Vec a, Vec b) {
    return Vec{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  forward_ = unit({t[0] - e[0], t[1] - e[1], t[2] - e[2]});
  // A view straight down has no horizon. In this view, the sensor's x axis points up.
  const bool vertical = std::abs(forward_.z) > 0.999F;
  right_ = vertical ? Vec{0, -1, 0} : unit(cross(forward_, {0, 0, 1}));
  up_ = cross(right_, forward_);
  focal_ = static_cast<float>(width) / 2 / std::tan(settings.field_of_view_deg / 360.0F * kPi);
}

void Renderer::Begin() {
  canvas_.Clear();
  scale_known_ = false;
  if (map_ != nullptr) FrameMap();
}

void Renderer::LearnScale(const CloudInfo& info, const std::uint8_t* points) {
  if (scale_known_) return;
  scale_known_ = true;
  low_ = settings_.color_min;
  high_ = settings_.color_max;
  if (high_ > low_) return;
  const Scale scale = DefaultScale(settings_.color_by, info.height);
  low_ = scale.low;
  high_ = scale.high;
  if (settings_.color_by != ColorBy::kIntensity) return;
  // Sensors scale intensity differently. The colour scale ends at the value that only one point in
  // fifty exceeds.
  std::vector<float> values;
  ForEachPoint(info, points, [&](const Point& p) { values.push_back(p.value); });
  if (values.empty()) return;
  const auto bright = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 49 / 50);
  std::nth_element(values.begin(), bright, values.end());
  high_ = std::max(*bright, 1e-6F);
}

Color Renderer::ColorOf(float value) const {
  const float t = (value - low_) / (high_ - low_);
  // The square root brightens dark values, because most values are dark.
  if (settings_.color_by == ColorBy::kIntensity) return Glow(t > 0 ? std::sqrt(t) : 0);
  return Spectrum(t);
}

std::optional<std::array<float, 3>> Renderer::Place(Vec p) const {
  if (settings_.view == ViewKind::kPerspective) return Project(p);
  const float x = static_cast<float>(canvas_.width()) / 2 + pixels_per_m_ * p.x;
  const float y = static_cast<float>(canvas_.height()) / 2 - pixels_per_m_ * p.y;
  if (!(std::abs(x) < 1e5F && std::abs(y) < 1e5F)) return std::nullopt;
  // The depth decreases with the height, so that higher points hide lower points.
  return std::array<float, 3>{x, y, std::max(1.0F, kAbove - p.z)};
}

void Renderer::PlotTop(const Point& point) {
  const auto at = Place(point.p);
  if (!at) return;
  const int size = settings_.point_size > 0 ? settings_.point_size
                                            : std::max(1, static_cast<int>(pixels_per_m_ * 0.12F));
  canvas_.Splat(static_cast<int>((*at)[0]), static_cast<int>((*at)[1]), size, (*at)[2],
                ColorOf(point.value));
}

std::optional<std::array<float, 3>> Renderer::Project(Vec p) const {
  const Vec d{p.x - settings_.eye_m[0], p.y - settings_.eye_m[1], p.z - settings_.eye_m[2]};
  const auto dot = [&](Vec v) { return d.x * v.x + d.y * v.y + d.z * v.z; };
  const float depth = dot(forward_);
  if (depth < 0.3F) return std::nullopt;
  const float x = static_cast<float>(canvas_.width()) / 2 + focal_ * dot(right_) / depth;
  const float y = static_cast<float>(canvas_.height()) / 2 - focal_ * dot(up_) / depth;
  if (!(std::abs(x) < 1e5F && std::abs(y) < 1e5F)) return std::nullopt;
  return std::array<float, 3>{x, y, depth};
}

void Renderer::PlotPerspective(const Point& point) {
  const auto at = Project(point.p);
  if (!at) return;
  const float depth = (*at)[2];
  const int size = settings_.point_size > 0
                       ? settings_.point_size
                       : std::clamp(static_cast<int>(focal_ * 0.05F / depth + 0.8F), 1, 6);
  canvas_.Splat(static_cast<int>((*at)[0]), static_cast<int>((*at)[1]), size, depth,
                ColorOf(point.value));
}

void Renderer::DrawRangeImage(const CloudInfo& info, const GstLidarSlice& slice,
                              const std::uint8_t* points) {
  const auto* model = info.sensor_model ? &*info.sensor_model : nullptr;
  // Limits the number of columns, because the meta is untrusted.
  constexpr guint64 kMost = SensorModel::kMaxColumns * guint64{4096};
  const guint64 all = guint64{info.width} * slice.slice_count;
  const guint turn = model != nullptr ? model->columns_per_scan
                                      : static_cast<guint>(std::clamp<guint64>(all, 1, kMost));
  ForEachPoint(info, points, [&](const Point& p) {
    const int shift = model != nullptr ? model->beams[p.beam].pixel_shift : 0;
    const auto column =
        (slice.first_column + p.column + turn +
         static_cast<guint>(shift % static_cast<int>(turn) + static_cast<int>(turn))) %
        turn;
    const auto pixel = [](guint i, guint n, int size) {
      return static_cast<int>(guint64{i} * static_cast<guint64>(size) / n);
    };
    canvas_.Fill(pixel(column, turn, canvas_.width()), pixel(p.beam, info.height, canvas_.height()),
                 pixel(column + 1, turn, canvas_.width()),
                 pixel(p.beam + 1, info.height, canvas_.height()), ColorOf(p.value));
  });
}

/// Draws an unorganised cloud. The azimuth gives the position in x, and the elevation the position
/// in y.
void Renderer::DrawPanorama(const CloudInfo& info, const std::uint8_t* points) {
  float low = kPi / 2;
  float high = -kPi / 2;
  ForEachPoint(info, points, [&](const Point& p) {
    low = std::min(low, std::asin(p.p.z / p.range));
    high = std::max(high, std::asin(p.p.z / p.range));
  });
  const float span = std::max(high - low, 0.01F);
  const auto width = static_cast<float>(canvas_.width());
  const auto height = static_cast<float>(canvas_.height());
  ForEachPoint(info, points, [&](const Point& p) {
    const float u = 0.5F - std::atan2(p.p.y, p.p.x) / (2 * kPi);
    const float v = (high - std::asin(p.p.z / p.range)) / span;
    canvas_.Splat(static_cast<int>(u * width), static_cast<int>(v * (height - 1)),
                  std::max(1, settings_.point_size > 0 ? settings_.point_size : 2), p.range,
                  ColorOf(p.value));
  });
}

void Renderer::Draw(const CloudInfo& info, const GstLidarSlice& slice, const std::uint8_t* points,
                    bool into_map) {
  LearnScale(info, points);
  if (map_ != nullptr) {
    DrawOverMap(info, slice, points, into_map);
    return;
  }
  switch (settings_.view) {
    case ViewKind::kTop:
      ForEachPoint(info, points, [this](const Point& p) { PlotTop(p); });
      break;
    case ViewKind::kPerspective:
      ForEachPoint(info, points, [this](const Point& p) { PlotPerspective(p); });
      break;
    case ViewKind::kRange:
      if (info.height > 1 || info.sensor_model) {
        DrawRangeImage(info, slice, points);
      } else {
        DrawPanorama(info, points);
      }
      break;
  }
}

/// Draws circles on the ground at intervals of ten metres, as a scale.
void Renderer::DrawRings() {
  constexpr int kCorners = 120;
  const auto at = [&](float radius, int i) {
    const float angle = 2 * kPi * static_cast<float>(i) / kCorners;
    return Place({radius * std::cos(angle), radius * std::sin(angle), kGround});
  };
  for (float radius = 10; radius <= 50; radius += 10) {
    for (int i = 0; i < kCorners; ++i) {
      const auto a = at(radius, i);
      const auto b = at(radius, i + 1);
      if (a && b) canvas_.Line((*a)[0], (*a)[1], (*b)[0], (*b)[1], kRing);
    }
  }
}

const Canvas& Renderer::Finish() {
  if (settings_.view == ViewKind::kRange) return canvas_;
  if (map_ != nullptr) DrawMap();
  // Edges are shaded more strongly in the view from above, because there a step of one metre
  // changes the depth by only 1 %.
  canvas_.ShadeEdges(settings_.view == ViewKind::kTop ? 6.0F : 2.0F);
  if (map_ != nullptr) {
    DrawWay();
    map_->EndScan();
    return canvas_;
  }
  DrawRings();
  if (settings_.view == ViewKind::kTop)
    canvas_.Fill(canvas_.width() / 2 - 2, canvas_.height() / 2 - 2, canvas_.width() / 2 + 3,
                 canvas_.height() / 2 + 3, kCar);
  return canvas_;
}

}  // namespace lidar::gst
