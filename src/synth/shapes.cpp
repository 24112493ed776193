// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/shapes.h"

#include <algorithm>

namespace lidar::synth {
namespace {

constexpr float kNearest = 0.05F;  // nearer points are inside the housing

/// The part of a ray that is inside of a convex body, and the normal of the face by which it
/// enters.
struct Span {
  float in = kNearest;
  float out = 1e9F;
  Vec3 normal;

  /// Keeps the part of the ray at whose points p the dot product of `face` and p is below `offset`.
  /// Returns false if no part is left.
  bool Clip(Vec3 face, float offset, const Ray& ray) {
    const float height = offset - Dot(face, ray.origin);
    const float rate = Dot(face, ray.direction);
    if (std::abs(rate) < 1e-9F) return height >= 0;
    const float t = height / rate;
    if (rate > 0) {
      out = std::min(out, t);
    } else if (t > in) {
      in = t;
      normal = face;
    }
    return in <= out;
  }
};

Vec3 ToLocal(const Shape& s, Vec3 v) {
  return {s.cos_yaw * v.x + s.sin_yaw * v.y, s.cos_yaw * v.y - s.sin_yaw * v.x, v.z};
}

Ray ToLocal(const Shape& s, const Ray& ray) {
  const Vec3 origin = ray.origin - s.center;
  if (s.sin_yaw == 0 && s.cos_yaw == 1) {
    Ray local = ray;
    local.origin = origin;
    return local;
  }
  return MakeRay(ToLocal(s, origin), ToLocal(s, ray.direction));
}

/// Finds where the ray enters a box that is centred on the origin. Uses a slab test.
bool EnterBox(Vec3 half, const Ray& r, Span* span) {
  const float tx = (r.inverse.x > 0 ? -half.x - r.origin.x : half.x - r.origin.x) * r.inverse.x;
  const float ty = (r.inverse.y > 0 ? -half.y - r.origin.y : half.y - r.origin.y) * r.inverse.y;
  const float tz = (r.inverse.z > 0 ? -half.z - r.origin.z : half.z - r.origin.z) * r.inverse.z;
  const float in = std::max({tx, ty, tz});
  const float ox = tx + 2 * half.x * std::abs(r.inverse.x);
  const float oy = ty + 2 * half.y * std::abs(r.inverse.y);
  const float oz = tz + 2 * half.z * std::abs(r.inverse.z);
  span->in = in;
  span->out = std::min({ox, oy, oz});
  if (in > span->out || in < kNearest) return false;
  if (in == tx) {
    span->normal = {1, 0, 0};
  } else if (in == ty) {
    span->normal = {0, 1, 0};
  } else {
    span->normal = {0, 0, 1};
  }
  return true;
}

bool EnterCabin(Vec3 half, const Ray& r, Span* span) {
  constexpr float kLean = 0.70710678F;  // the front and rear windows lean by 45 degrees
  const float screen = kLean * (half.x - half.z);
  return span->Clip({0, 1, 0}, half.y, r) && span->Clip({0, -1, 0}, half.y, r) &&
         span->Clip({0, 0, 1}, half.z, r) && span->Clip({0, 0, -1}, half.z, r) &&
         span->Clip({kLean, 0, kLean}, screen, r) && span->Clip({-kLean, 0, kLean}, screen, r) &&
         span->in > kNearest;
}

/// The origin and the direction of a ray in the coordinates of a cylinder, whose axis is w.
struct Axes {
  float ou, ov, ow;
  float du, dv, dw;
};
/// Finds where the ray enters a cylinder. Tests the infinite cylinder u^2 + v^2 = radius^2 first,
/// and then the caps at |w| = half.
bool EnterCylinder(const Axes& a, float radius, float half, Span* span, float* cosine) {
  const float aa = a.du * a.du + a.dv * a.dv + 1e-12F;
  const float b = a.ou * a.du + a.ov * a.dv;
  const float c = a.ou * a.ou + a.ov * a.ov - radius * radius;
  const float root2 = b * b - aa * c;
  if (root2 < 0) return false;
  const float root = std::sqrt(root2);
  const float side = (-b - root) / aa;
  if (side > kNearest && std::abs(a.ow + side * a.dw) <= half) {
    span->in = side;
    *cosine = root / radius;
    return true;
  }
  const float cap = ((a.dw > 0 ? -half : half) - a.ow) / (std::abs(a.dw) > 1e-9F ? a.dw : 1e-9F);
  const float u = a.ou + cap * a.du;
  const float v = a.ov + cap * a.dv;
  span->in = cap;
  *cosine = std::abs(a.dw);
  return cap > kNearest && u * u + v * v <= radius * radius;
}

bool EnterEllipsoid(Vec3 half, const Ray& r, Span* span, float* cosine) {
  const Vec3 o{r.origin.x / half.x, r.origin.y / half.y, r.origin.z / half.z};
  const Vec3 d{r.direction.x / half.x, r.direction.y / half.y, r.direction.z / half.z};
  const float a = Dot(d, d);
  const float b = Dot(o, d);
  const float root2 = b * b - a * (Dot(o, o) - 1);
  if (root2 < 0) return false;
  const float root = std::sqrt(root2);
  span->in = (-b - root) / a;
  span->out = (-b + root) / a;
  const Vec3 p = o + span->in * d;
  const Vec3 normal{p.x / half.x, p.y / half.y, p.z / half.z};
  *cosine = std::abs(Dot(normal, r.direction)) / std::sqrt(Dot(normal, normal) + 1e-12F);
  return span->in > kNearest;
}

/// Adds windows to a façade. There is one row of windows in each storey, and they lie deep in the
/// wall. Some windows have curtains. The others absorb the light, except for an echo of the pane if
/// the ray is nearly perpendicular to it.
void TextureFacade(const Shape& s, const Ray& local, Random* noise, const Span& span, Hit* hit) {
  constexpr float kStorey = 3.2F;
  constexpr float kBay = 2.8F;
  constexpr float kRecess = 0.18F;
  if (span.normal.z != 0) return;
  const bool long_side = span.normal.y != 0;
  const Vec3 p = local.origin + span.in * local.direction + s.half;
  const float bay = (long_side ? p.x : p.y) / kBay;
  const float storey = p.z / kStorey;
  const float u = bay - std::floor(bay);
  const float v = storey - std::floor(storey);
  if (u < 0.25F || u > 0.75F || v < 0.28F || v > 0.78F) return;
  hit->distance +=
      std::min(kRecess * std::abs(long_side ? local.inverse.y : local.inverse.x), 2.0F);
  // The reflectivity serves as the number of the house, because it does not depend on the anchor.
  const auto house = static_cast<std::uint64_t>(s.reflectivity * 1e6F);
  const auto window = static_cast<std::uint64_t>(storey) * 64 + static_cast<std::uint64_t>(bay);
  const bool curtain = Random(house * 4096 + window).Chance(0.55F);
  const bool seen = hit->cosine > 0.985F || noise->Chance(curtain ? 0.97F : 0.05F);
  hit->reflectivity = seen ? 0.25F : 0.0F;
}

bool EnterFoliage(const Shape& s, Random* noise, Span* span) {
  // The length of a ray's path in leaves has an exponential distribution. Its mean is proportional
  // to half.x.
  const float mean = 0.55F * s.half.x;
  const float depth = -mean * std::log(1.0F - noise->Uniform());
  span->in += depth;
  return span->in < span->out;
}

}  // namespace

bool Intersect(const Shape& shape, const Ray& ray, Random* noise, Hit* hit) {
  const Ray local = ToLocal(shape, ray);
  const Vec3 o = local.origin;
  const Vec3 d = local.direction;
  Span span;
  float cosine = 0;
  bool met = false;
  switch (shape.kind) {
    case ShapeKind::kBox:
      met = EnterBox(shape.half, local, &span);
      cosine = std::abs(Dot(span.normal, d));
      break;
    case ShapeKind::kCabin:
      met = EnterCabin(shape.half, local, &span);
      cosine = std::abs(Dot(span.normal, d));
      break;
    case ShapeKind::kColumn:
      met =
          EnterCylinder({o.x, o.y, o.z, d.x, d.y, d.z}, shape.half.x, shape.half.z, &span, &cosine);
      break;
    case ShapeKind::kBar:
      met =
          EnterCylinder({o.y, o.z, o.x, d.y, d.z, d.x}, shape.half.y, shape.half.x, &span, &cosine);
      break;
    case ShapeKind::kEllipsoid:
    case ShapeKind::kFoliage:
      met = EnterEllipsoid(shape.half, local, &span, &cosine);
      break;
  }
  if (!met || span.in >= hit->distance) return false;
  if (shape.kind == ShapeKind::kFoliage) {
    if (!EnterFoliage(shape, noise, &span) || span.in >= hit->distance) return false;
    cosine = 0.3F + 0.7F * noise->Uniform();
  }
  *hit = {span.in, shape.reflectivity, cosine};
  if (shape.surface == Surface::kFacade) TextureFacade(shape, local, noise, span, hit);
  // Glass reflects the light away, unless the ray is nearly perpendicular to it.
  if (shape.surface == Surface::kGlass && cosine < 0.9F) hit->reflectivity *= 0.08F;
  return true;
}

}  // namespace lidar::synth
