// SPDX-License-Identifier: LGPL-2.1-or-later
// Draws clouds: from above, in perspective, or as the range image of the sensor.
#pragma once
#include <array>
#include <optional>

#include "gst/common/cloud_info.h"
#include "gst/view/canvas.h"
#include "gst/view/cloud_reader.h"

namespace lidar::gst {

enum class ViewKind { kTop, kPerspective, kRange };
enum class ColorBy { kHeight, kIntensity, kRange, kRing };

struct ViewSettings {
  ViewKind view = ViewKind::kPerspective;
  ColorBy color_by = ColorBy::kHeight;
  float extent_m = 100;  // top: width of the picture
  std::array<float, 3> eye_m{};
  std::array<float, 3> target_m{};
  float field_of_view_deg = 60;  // horizontal
  int point_size = 0;            // pixels; 0: by distance
  float color_min = 0;           // both equal: automatic
  float color_max = 0;
};

/// One picture at a time: Begin, Draw for each slice, Finish.
class Renderer {
 public:
  Renderer(const ViewSettings& settings, int width, int height);

  void Begin();
  /// `points`: info.FrameSize() bytes, whose fields have x, y, z as F32 side by side.
  void Draw(const CloudInfo& info, const GstLidarSlice& slice, const std::uint8_t* points);
  const Canvas& Finish();

 private:
  struct Vec {
    float x, y, z;
  };
  struct Point {
    Vec p;
    float range;
    float value;  // what the colour tells, as read
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
  std::optional<std::array<float, 3>> Project(Vec p) const;  // x, y in pixels; depth

  ViewSettings settings_;
  Canvas canvas_;
  float low_ = 0;
  float high_ = 1;
  bool scale_known_ = false;
  // The camera: right, up, forward, and pixels per tangent.
  Vec right_{}, up_{}, forward_{};
  float focal_ = 1;
};

}  // namespace lidar::gst
