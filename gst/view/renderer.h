// SPDX-License-Identifier: LGPL-2.1-or-later
// Draws clouds: from above, in perspective, or as the range image of the sensor.
#pragma once
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "gst/lidar/cloud_info.h"
#include "gst/view/canvas.h"
#include "gst/view/cloud_reader.h"
#include "gst/view/trail_map.h"

namespace lidar::gst {

enum class ViewKind { kTop, kPerspective, kRange };
enum class ColorBy { kHeight, kIntensity, kRange, kRing };

struct ViewSettings {
  ViewKind view = ViewKind::kPerspective;
  ColorBy color_by = ColorBy::kHeight;
  float extent_m = 100;  // width of the picture from above
  std::array<float, 3> eye_m{};
  std::array<float, 3> target_m{};
  float field_of_view_deg = 60;  // horizontal
  int point_size = 0;            // pixels; 0: by distance
  float color_min = 0;           // not below color_max: automatic
  float color_max = 0;
};

constexpr float kGround = -1.9F;  // below the sensor [m]

/// Draws one picture at a time: call Begin(), Draw() for each slice, and Finish().
class Renderer {
 public:
  /// If there is a `map`, and poses for it, each scan is drawn at its pose, over the earlier scans.
  /// The picture from above shows the whole route of the sensor. In perspective, the camera is
  /// behind the sensor and stays level. `map` must outlive the renderer.
  Renderer(const ViewSettings& settings, int width, int height, TrailMap* map);

  void Begin();
  /// Draws a slice. `points` has info.FrameSize() bytes, and the fields x, y and z of each point
  /// are adjacent F32. If `into_map` is true, adds the points to the map.
  void Draw(const CloudInfo& info, const GstLidarSlice& slice, const std::uint8_t* points,
            bool into_map);
  const Canvas& Finish();

 private:
  struct Vec {
    float x, y, z;
  };
  struct Point {
    Vec p;
    float range;
    float value;  // the value that determines the colour
    guint beam;
    guint column;
  };

  template <class Plot>
  void ForEachPoint(const CloudInfo& info, const std::uint8_t* points, const Plot& plot);
  void LearnScale(const CloudInfo& info, const std::uint8_t* points);
  Color ColorOf(float value) const;
  void PlotTop(const Point& point);
  void PlotPerspective(const Point& point);
  void DrawRangeImage(const CloudInfo& info, const GstLidarSlice& slice,
                      const std::uint8_t* points);
  void DrawPanorama(const CloudInfo& info, const std::uint8_t* points);
  void DrawRings();
  void FrameMap();
  void DrawOverMap(const CloudInfo& info, const GstLidarSlice& slice, const std::uint8_t* points,
                   bool into_map);
  void DrawMap();
  void DrawWay();
  Vec ToPicture(const std::array<float, 3>& at) const;
  std::optional<std::array<float, 3>> Project(Vec p) const;  // x, y in pixels, and the depth
  /// Returns the position of `p` in the picture, as Project() does, but for the view in the
  /// settings.
  std::optional<std::array<float, 3>> Place(Vec p) const;

  ViewSettings settings_;
  Canvas canvas_;
  float low_ = 0;
  float high_ = 1;
  bool scale_known_ = false;
  float pixels_per_m_;  // in the view from above
  TrailMap* map_;
  // The view of the map: the point in the middle of the picture, and the angle of the picture.
  std::array<float, 3> middle_{};
  float cos_turn_ = 1;
  float sin_turn_ = 0;
  // The camera: its axes to the right, up and forward, and its focal length [pixels].
  Vec right_{}, up_{}, forward_{};
  float focal_ = 1;
};

template <class Plot>
void Renderer::ForEachPoint(const CloudInfo& info, const std::uint8_t* points, const Plot& plot) {
  const guint xyz = info.fields.Find("x")->offset;
  const auto intensity = FieldReader::Find(info.fields, {"intensity", "reflectivity", "signal"});
  for (guint beam = 0; beam < info.height; ++beam) {
    for (guint column = 0; column < info.width; ++column, points += info.point_step) {
      Point point{};
      std::memcpy(&point.p, points + xyz, sizeof point.p);
      const Vec& p = point.p;
      point.range = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
      // Some sources set a missing return to zero, and others to NaN.
      if (!(point.range > 0.01F && point.range < 1e5F)) continue;
      point.beam = beam;
      point.column = column;
      switch (settings_.color_by) {
        case ColorBy::kHeight:
          point.value = p.z;
          break;
        case ColorBy::kIntensity:
          point.value = intensity ? (*intensity)(points) : 0;
          break;
        case ColorBy::kRange:
          point.value = point.range;
          break;
        case ColorBy::kRing:
          point.value = static_cast<float>(beam);
          break;
      }
      plot(point);
    }
  }
}

}  // namespace lidar::gst
