// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/sector_index.h"

#include <algorithm>
#include <array>

namespace lidar::synth {
namespace {

/// The rectangle that a shape covers on the ground, relative to the sensor.
struct Footprint {
  float nearest = 0;
  float farthest = 0;
  float angle = 0;  // pseudo-angle at which it begins
  float width = 4;  // pseudo-angle that it spans; 4 if the sensor is within the rectangle

  Footprint(const Shape& s, Vec3 origin, float margin) {
    const float hx = s.half.x + margin;
    const float hy = s.half.y + margin;
    const float cx = s.center.x - origin.x;
    const float cy = s.center.y - origin.y;
    // Computes the distance from the sensor to the rectangle, in the frame of the shape.
    const float lx = std::abs(s.cos_yaw * cx + s.sin_yaw * cy);
    const float ly = std::abs(s.cos_yaw * cy - s.sin_yaw * cx);
    const float dx = std::max(0.0F, lx - hx);
    const float dy = std::max(0.0F, ly - hy);
    nearest = std::sqrt(dx * dx + dy * dy);
    farthest = std::sqrt((lx + hx) * (lx + hx) + (ly + hy) * (ly + hy));
    if (nearest <= 0) return;
    const float middle = PseudoAngle(cx, cy);
    float low = 0;
    float high = 0;
    for (const auto& [u, v] :
         {std::array{hx, hy}, std::array{hx, -hy}, std::array{-hx, hy}, std::array{-hx, -hy}}) {
      float d =
          PseudoAngle(cx + s.cos_yaw * u - s.sin_yaw * v, cy + s.sin_yaw * u + s.cos_yaw * v) -
          middle;
      if (d > 2) d -= 4;
      if (d < -2) d += 4;
      low = std::min(low, d);
      high = std::max(high, d);
    }
    angle = middle + low;
    if (angle < 0) angle += 4;
    width = high - low;
  }
};

float WrapUnit(float p) { return p >= 4 ? p - 4 : (p < 0 ? p + 4 : p); }

bool Touches(const Footprint& f, SectorIndex::Arc arc) {
  return WrapUnit(f.angle - arc.start) <= arc.width || WrapUnit(arc.start - f.angle) <= f.width;
}

}  // namespace

void SectorIndex::AddCandidate(const Shape& shape, std::uint32_t index, Vec3 origin, float margin,
                               Arc arc) {
  const Footprint f(shape, origin, margin);
  if (!Touches(f, arc)) return;
  const float top = shape.center.z + shape.half.z + margin - origin.z;
  const float bottom = shape.center.z - shape.half.z - margin - origin.z;
  const float near = std::max(f.nearest, 1e-3F);
  Candidate c;
  c.entry = {f.nearest, bottom / (bottom < 0 ? near : f.farthest),
             top / (top > 0 ? near : f.farthest), index};
  c.first_sector = static_cast<std::uint32_t>(f.angle * kSectorsPerUnit);
  const float end = (f.angle + f.width) * kSectorsPerUnit;
  c.sectors = std::min(static_cast<std::uint32_t>(end) - c.first_sector + 1,
                       static_cast<std::uint32_t>(kSectors));
  candidates_.push_back(c);
}

void SectorIndex::Build(const std::vector<Shape>& shapes, Vec3 origin, float margin, Arc arc) {
  candidates_.clear();
  for (std::size_t i = 0; i < shapes.size(); ++i)
    AddCandidate(shapes[i], static_cast<std::uint32_t>(i), origin, margin, arc);
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    return a.entry.nearest < b.entry.nearest ||
           (!(b.entry.nearest < a.entry.nearest) && a.entry.shape < b.entry.shape);
  });
  FillSectors();
}

void SectorIndex::FillSectors() {
  std::fill(starts_.begin(), starts_.end(), 0);
  for (const Candidate& c : candidates_)
    for (std::uint32_t i = 0; i < c.sectors; ++i) ++starts_[(c.first_sector + i) % kSectors + 1];
  for (std::size_t i = 0; i < kSectors; ++i) starts_[i + 1] += starts_[i];
  entries_.resize(starts_.back());
  next_.assign(starts_.begin(), starts_.end() - 1);
  for (const Candidate& c : candidates_)
    for (std::uint32_t i = 0; i < c.sectors; ++i)
      entries_[next_[(c.first_sector + i) % kSectors]++] = c.entry;
}

}  // namespace lidar::synth
