// SPDX-License-Identifier: LGPL-2.1-or-later
// A picture whose pixels have a depth, so that near pixels hide far ones.
#pragma once
#include <cstdint>
#include <vector>

namespace lidar::gst {

struct Color {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
};

class Canvas {
 public:
  static constexpr float kFar = 1e9F;

  Canvas(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  const Color* Row(int y) const { return &pixels_[Index(0, y)]; }

  void Clear();
  /// Draws a square of `size` pixels around (x, y). Parts outside of the picture are not drawn.
  void Splat(int x, int y, int size, float depth, Color color);
  /// Fills the rectangle [x0, x1) x [y0, y1).
  void Fill(int x0, int y0, int x1, int y1, Color color);
  /// Draws a half-transparent line on the background. Pixels that were already drawn hide the line.
  void Line(float x0, float y0, float x1, float y1, Color color);
  struct End {
    float x, y, depth;
  };
  /// Draws a line that is `size` pixels wide, from the depth of `from` to the depth of `to`. Nearer
  /// pixels hide the line.
  void Stroke(End from, End to, int size, Color color);
  /// Darkens pixels that are farther than the pixels next to them, so that edges become visible
  /// (eye-dome lighting).
  void ShadeEdges(float strength);

 private:
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_;
  int height_;
  std::vector<Color> pixels_;
  std::vector<float> depth_;
  std::vector<float> log_depth_;
};

}  // namespace lidar::gst
