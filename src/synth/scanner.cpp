// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/scanner.h"

#include <algorithm>
#include <cmath>

namespace lidar::synth {
namespace {

constexpr Duration kChunk = std::chrono::milliseconds(2);
constexpr float kFastest = 25;  // greatest speed of things in a scene [m/s]
constexpr std::size_t kGaussBits = 12;
constexpr float kHalfDivergence = 0.0015F;  // half of a beam's divergence [rad]

/// Returns normal deviates of at most four standard deviations. Random bits choose one of them.
std::vector<float> MakeGaussTable() {
  constexpr double kTurn = 6.28318530717958647692;
  std::vector<float> table(std::size_t{1} << kGaussBits);
  Random random(0x6A09E667F3BCC908ULL);
  for (float& value : table) {
    const double u = 1.0 - static_cast<double>(random.Uniform());
    const double v = static_cast<double>(random.Uniform());
    value = static_cast<float>(
        std::clamp(std::sqrt(-2 * std::log(u)) * std::cos(kTurn * v), -4.0, 4.0));
  }
  return table;
}

/// Returns a direction on the rim of a beam. `axis` is the axis of the beam, and `turn` is the
/// angle around the axis [rad].
Vec3 OnTheRim(Vec3 axis, float turn) {
  const float horizontal = std::sqrt(axis.x * axis.x + axis.y * axis.y) + 1e-9F;
  const Vec3 left{-axis.y / horizontal, axis.x / horizontal, 0};
  const Vec3 up{-axis.x * axis.z / horizontal, -axis.y * axis.z / horizontal, horizontal};
  const Vec3 rim = axis + kHalfDivergence * (std::cos(turn) * left + std::sin(turn) * up);
  return (1 / std::sqrt(Dot(rim, rim))) * rim;
}

TrajectorySettings LaneOf(const Scene& scene, const ScannerConfig& config) {
  TrajectorySettings lane = scene.Lane(config.speed_mps);
  lane.sway_m *= config.roughness;
  lane.bounce *= config.roughness;
  return lane;
}

}  // namespace

Scanner::Scanner(const ScannerConfig& config)
    : config_(config),
      rays_(config.sensor),
      reach_m_(static_cast<float>(config.sensor.max_range_m)),
      signal_scale_(static_cast<float>(10 * config.sensor.range_of_10_percent_m *
                                       config.sensor.range_of_10_percent_m)),
      gauss_(MakeGaussTable()),
      scene_(Scene::Make(config.scene, config.seed)),
      trajectory_(LaneOf(*scene_, config)),
      chunk_columns_(
          std::max(1U, static_cast<std::uint32_t>(rays_.columns() * kChunk / config.period))) {
  view_.radius = reach_m_ + static_cast<float>(kAnchorStep);
  MoveAnchor(0, 0);
}

Duration Scanner::ColumnTime(std::uint64_t scan, std::uint32_t column) const {
  return config_.period * static_cast<std::int64_t>(scan) +
         config_.period * std::int64_t{column} / std::int64_t{rays_.columns()};
}

void Scanner::MoveAnchor(double x, double y) {
  const double anchor_x = std::floor(x / kAnchorStep) * kAnchorStep;
  // The anchor's y is 0 in worlds along x, because sensors stay within half a step of the middle.
  const double anchor_y = std::round(y / kAnchorStep) * kAnchorStep;
  if (anchor_x == view_.anchor_x && anchor_y == view_.anchor_y && !shapes_.empty()) return;
  view_.anchor_x = anchor_x;
  view_.anchor_y = anchor_y;
  shapes_.clear();
  scene_->MoveTo(view_);
  scene_->AddStatic(view_, &shapes_);
  static_shapes_ = shapes_.size();
}

Scanner::Column Scanner::MakeColumn(std::uint64_t scan, std::uint32_t column) const {
  const Duration time = ColumnTime(scan, column);
  const Pose pose = trajectory_.At(time);
  Column c;
  c.index = column;
  c.rotation = pose.ToRotation();
  c.origin = Vec3{static_cast<float>(pose.x - view_.anchor_x),
                  static_cast<float>(pose.y - view_.anchor_y), static_cast<float>(pose.z)} +
             c.rotation * rays_.Origin(column);
  c.age_s = static_cast<float>(Seconds(time - chunk_time_));
  c.key = Mix(Mix(config_.seed + scan * 0x10001) + column);
  return c;
}

SectorIndex::Arc Scanner::ArcOf(std::uint64_t scan, std::uint32_t first, std::uint32_t last) const {
  float low = 0;
  float high = 0;
  float start = -1;
  for (const std::uint32_t column : {first, last}) {
    const Column c = MakeColumn(scan, column);
    for (std::uint32_t beam = 0; beam < rays_.beams(); ++beam) {
      const Vec3 d = c.rotation * rays_.Direction(scan, beam, column);
      const float angle = PseudoAngle(d.x, d.y);
      if (start < 0) start = angle;
      float offset = angle - start;
      if (offset > 2) offset -= 4;
      if (offset < -2) offset += 4;
      low = std::min(low, offset);
      high = std::max(high, offset);
    }
  }
  // The arc is widened, because the pose also changes slightly between the first and the last
  // column.
  constexpr float kSlack = 0.02F;
  const float from = start + low - kSlack;
  return {from < 0 ? from + 4 : from, high - low + 2 * kSlack};
}

void Scanner::BeginChunk(std::uint64_t scan, std::uint32_t chunk) {
  const std::uint32_t first = chunk * chunk_columns_;
  const std::uint32_t last = std::min(first + chunk_columns_, rays_.columns()) - 1;
  chunk_time_ = ColumnTime(scan, first);
  const Pose pose = trajectory_.At(chunk_time_);
  MoveAnchor(pose.x, pose.y);
  shapes_.resize(static_shapes_);
  scene_->AddMoving(view_, {Seconds(chunk_time_), pose.x, trajectory_.speed(), pose.y}, &shapes_);
  const float margin = 0.05F + static_cast<float>(Seconds(kChunk)) *
                                   (static_cast<float>(trajectory_.speed()) + kFastest);
  index_.Build(shapes_, MakeColumn(scan, first).origin, margin, ArcOf(scan, first, last));
}

Hit Scanner::Trace(const Ray& ray, float age_s, Random* noise) const {
  Hit hit;
  hit.distance = reach_m_;
  const bool ground_first = scene_->GroundFirst(ray);
  if (ground_first) scene_->IntersectGround(view_, ray, noise, &hit);
  for (const auto& entry : index_.Find(PseudoAngle(ray.direction.x, ray.direction.y))) {
    if (entry.nearest > hit.distance * ray.horizontal) break;
    if (ray.slope > entry.max_slope || ray.slope < entry.min_slope) continue;
    const Shape& shape = shapes_[entry.shape];
    if (entry.shape < static_shapes_) {
      Intersect(shape, ray, noise, &hit);
    } else {
      Ray relative = ray;
      relative.origin = ray.origin - age_s * shape.velocity;
      Intersect(shape, relative, noise, &hit);
    }
  }
  if (!ground_first) scene_->IntersectGround(view_, ray, noise, &hit);
  return hit;
}

Scanner::Pixel Scanner::Measure(const Hit& hit, Random* noise) const {
  constexpr float kDropout = 0.998F;
  constexpr float kPhotons = 40;  // number of photons of an echo whose `signal` is 1
  const float range = hit.distance + rays_.origin_m();
  // The signal is 1 for a target of 10 % reflectivity at the range at which nine of ten pulses
  // return.
  const float signal = hit.reflectivity * hit.cosine * signal_scale_ / (range * range);
  const std::uint64_t bits = noise->Bits();
  const float chance = kDropout * signal * signal / (signal * signal + 0.11F);
  const float drawn = static_cast<float>(bits >> 40) * 0x1p-24F;
  if (hit.distance >= reach_m_ || !(drawn < chance)) return {};
  // Weak echoes are timed less exactly. The weakest ones have three times the noise.
  const float sigma = static_cast<float>(config_.noise_m) * (1 + 2 / (1 + signal * signal));
  const float deviate = gauss_[bits & ((1U << kGaussBits) - 1)];
  const float measured = range + sigma * deviate;
  if (measured < static_cast<float>(config_.sensor.min_range_m) || measured > reach_m_) return {};
  const float speckle = 0.95F + 0.1F * static_cast<float>((bits >> 16) & 0xFFF) / 4096.0F;
  const float reflectivity =
      hit.reflectivity <= 1 ? 100 * hit.reflectivity : 100 + 110 * (hit.reflectivity - 1);
  return {static_cast<std::uint32_t>(measured * 1000 + 0.5F),
          static_cast<std::uint8_t>(std::min(255.0F, reflectivity * speckle + 0.5F)),
          static_cast<std::uint16_t>(std::min(65535.0F, kPhotons * signal * speckle + 0.5F))};
}

/// Measures the two echoes of a beam. A beam has a width, so a part of it continues to a farther
/// surface at an edge or in leaves. A sensor separates two surfaces only if their echoes do not
/// overlap.
Scanner::Echoes Scanner::MeasureBoth(const Column& column, Vec3 direction, const Hit& center,
                                     Random* noise) const {
  constexpr float kSeparation = 0.5F;  // [m]
  constexpr float kCenterShare = 0.6F;
  constexpr float kTurn = 6.2831853F;
  Random edge(noise->Bits());
  const Vec3 rim = OnTheRim(direction, kTurn * edge.Uniform());
  const Hit beside = Trace(MakeRay(column.origin, rim), column.age_s, &edge);
  if (std::abs(beside.distance - center.distance) < kSeparation)
    return {Measure(center, noise), {}};
  const auto share = [](Hit hit, float part) {
    hit.reflectivity *= part;
    return hit;
  };
  const Pixel a = Measure(share(center, kCenterShare), noise);
  const Pixel b = Measure(share(beside, 1 - kCenterShare), &edge);
  const bool a_leads = b.range_mm == 0 || (a.range_mm != 0 && a.signal >= b.signal);
  return a_leads ? Echoes{a, b} : Echoes{b, a};
}

/// Returns the hits of a column's beams. Draws the same noise as Cast() does for this column.
std::vector<Hit> Scanner::TraceColumn(std::uint64_t scan, std::uint32_t index) {
  BeginChunk(scan, index / chunk_columns_);
  const Column column = MakeColumn(scan, index);
  std::vector<Hit> hits;
  for (std::uint32_t beam = 0; beam < rays_.beams(); ++beam) {
    Random noise(column.key + beam);
    const Vec3 direction = column.rotation * rays_.Direction(scan, beam, index);
    hits.push_back(Trace(MakeRay(column.origin, direction), column.age_s, &noise));
  }
  return hits;
}

/// Mixes the echoes of two surfaces if the beam meets an edge. The range then lies between those of
/// the surfaces.
Hit Scanner::MixWith(const Hit& beside, Hit hit, Random* noise) const {
  constexpr float kPulse = 1.0F;  // least distance at which echoes are separate [m]
  constexpr float kSurface = 0.15F;
  const float apart = std::abs(beside.distance - hit.distance);
  if (!(apart > kSurface && apart < kPulse)) return hit;
  const float pitch = 6.2831853F / static_cast<float>(rays_.columns());
  Random edge(noise->Bits());
  if (!edge.Chance(std::min(1.0F, 2 * kHalfDivergence / pitch))) return hit;
  const float share = edge.Uniform();
  hit.distance += share * (beside.distance - hit.distance);
  hit.reflectivity += share * (beside.reflectivity - hit.reflectivity);
  return hit;
}

void Scanner::Cast(std::uint64_t scan, ColumnWindow window, Returns* returns) {
  const std::uint32_t beams = rays_.beams();
  returns->range_mm.resize(std::size_t{beams} * window.count);
  returns->reflectivity.resize(returns->range_mm.size());
  returns->signal.resize(returns->range_mm.size());
  const std::size_t seconds = config_.second_returns ? returns->range_mm.size() : 0;
  returns->range2_mm.resize(seconds);
  returns->reflectivity2.resize(seconds);
  returns->signal2.resize(seconds);
  // Traces the column before the window, because the ranges must not depend on where a window
  // begins.
  std::vector<Hit> beside;
  if (config_.mixed_pixels && window.first > 0) beside = TraceColumn(scan, window.first - 1);
  std::uint32_t chunk = UINT32_MAX;
  for (std::uint32_t i = 0; i < window.count; ++i) {
    const std::uint32_t index = window.first + i;
    if (index / chunk_columns_ != chunk) BeginChunk(scan, chunk = index / chunk_columns_);
    const Column column = MakeColumn(scan, index);
    for (std::uint32_t beam = 0; beam < beams; ++beam) {
      Random noise(column.key + beam);
      const Vec3 direction = column.rotation * rays_.Direction(scan, beam, index);
      Hit hit = Trace(MakeRay(column.origin, direction), column.age_s, &noise);
      if (config_.mixed_pixels) {
        const Hit traced = hit;
        if (index > 0) hit = MixWith(beside[beam], hit, &noise);
        beside.resize(beams);
        beside[beam] = traced;
      }
      const Echoes echoes = config_.second_returns ? MeasureBoth(column, direction, hit, &noise)
                                                   : Echoes{Measure(hit, &noise), {}};
      const std::size_t at = std::size_t{beam} * window.count + i;
      returns->range_mm[at] = echoes.strongest.range_mm;
      returns->reflectivity[at] = echoes.strongest.reflectivity;
      returns->signal[at] = echoes.strongest.signal;
      if (!config_.second_returns) continue;
      returns->range2_mm[at] = echoes.second.range_mm;
      returns->reflectivity2[at] = echoes.second.reflectivity;
      returns->signal2[at] = echoes.second.signal;
    }
  }
}

}  // namespace lidar::synth
