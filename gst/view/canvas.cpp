// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/view/canvas.h"

#include <algorithm>
#include <cmath>

#include "gst/view/palette.h"

namespace lidar::gst {
namespace {

constexpr Color kSky{13, 15, 22};
constexpr Color kFloor{27, 31, 42};

}  // namespace

Canvas::Canvas(int width, int height)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
      depth_(pixels_.size(), kFar),
      log_depth_(pixels_.size(), 0) {
  Clear();
}

void Canvas::Clear() {
  for (int y = 0; y < height_; ++y) {
    const Color background =
        Mix(kSky, kFloor, static_cast<float>(y) / static_cast<float>(std::max(1, height_ - 1)));
    std::fill_n(pixels_.begin() + static_cast<std::ptrdiff_t>(Index(0, y)), width_, background);
  }
  std::fill(depth_.begin(), depth_.end(), kFar);
}

void Canvas::Splat(int x, int y, int size, float depth, Color color) {
  const int x0 = std::max(0, x - size / 2);
  const int y0 = std::max(0, y - size / 2);
  const int x1 = std::min(width_, x - size / 2 + size);
  const int y1 = std::min(height_, y - size / 2 + size);
  for (int py = y0; py < y1; ++py) {
    for (int px = x0; px < x1; ++px) {
      const std::size_t i = Index(px, py);
      if (depth >= depth_[i]) continue;
      depth_[i] = depth;
      pixels_[i] = color;
    }
  }
}

void Canvas::Fill(int x0, int y0, int x1, int y1, Color color) {
  x0 = std::max(0, x0);
  x1 = std::min(width_, x1);
  for (int y = std::max(0, y0); y < std::min(height_, y1); ++y)
    for (int x = x0; x < x1; ++x) pixels_[Index(x, y)] = color;
}

void Canvas::Line(float x0, float y0, float x1, float y1, Color color) {
  const float length = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
  if (!(length < 1e5F)) return;
  const int steps = static_cast<int>(length) + 1;
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    const int x = static_cast<int>(std::floor(x0 + t * (x1 - x0)));
    const int y = static_cast<int>(std::floor(y0 + t * (y1 - y0)));
    if (x < 0 || y < 0 || x >= width_ || y >= height_ || depth_[Index(x, y)] < kFar) continue;
    pixels_[Index(x, y)] = Mix(pixels_[Index(x, y)], color, 0.5F);
  }
}

void Canvas::Stroke(End from, End to, int size, Color color) {
  const float length = std::max(std::abs(to.x - from.x), std::abs(to.y - from.y));
  if (!(length < 1e5F)) return;
  const int steps = static_cast<int>(length) + 1;
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    const auto between = [t](float a, float b) { return a + t * (b - a); };
    Splat(static_cast<int>(std::floor(between(from.x, to.x))),
          static_cast<int>(std::floor(between(from.y, to.y))), size, between(from.depth, to.depth),
          color);
  }
}

void Canvas::ShadeEdges(float strength) {
  for (std::size_t i = 0; i < depth_.size(); ++i)
    log_depth_[i] = depth_[i] < kFar ? std::log2(std::max(depth_[i], 0.01F)) : 1e3F;
  for (int y = 1; y + 1 < height_; ++y) {
    for (int x = 1; x + 1 < width_; ++x) {
      const std::size_t i = Index(x, y);
      if (depth_[i] >= kFar) continue;
      float sum = 0;
      for (const std::size_t n : {i - 1, i + 1, Index(x, y - 1), Index(x, y + 1)})
        sum += std::clamp(log_depth_[i] - log_depth_[n], 0.0F, 1.0F);
      const float light = std::exp(-strength * sum);
      Color& c = pixels_[i];
      c = {static_cast<std::uint8_t>(static_cast<float>(c.r) * light),
           static_cast<std::uint8_t>(static_cast<float>(c.g) * light),
           static_cast<std::uint8_t>(static_cast<float>(c.b) * light)};
    }
  }
}

}  // namespace lidar::gst
