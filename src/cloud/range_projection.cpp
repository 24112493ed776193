// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/range_projection.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/cloud/point_math.h"

namespace lidar {
namespace {

constexpr float kMetresPerMm = 1e-3F;

double Radians(double degrees) { return degrees * kPi / 180.0; }

std::array<float, 3> Apply(const std::array<float, 9>& m, const std::array<float, 3>& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

// Numbers of four columns, which fit a vector register of the processor.
using Floats = float __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(16)));

template <class V, class T>
V Load(const T* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

/// Writes x, y and z of four points. If `bytes` is 16, also writes the four bytes of `behind` after
/// each point.
void StorePoints(Floats x, Floats y, Floats z, Floats behind, std::size_t bytes, std::uint8_t* to,
                 std::size_t point_step) {
  const Floats xy_low = __builtin_shufflevector(x, y, 0, 4, 1, 5);
  const Floats xy_high = __builtin_shufflevector(x, y, 2, 6, 3, 7);
  const Floats z_low = __builtin_shufflevector(z, behind, 0, 4, 1, 5);
  const Floats z_high = __builtin_shufflevector(z, behind, 2, 6, 3, 7);
  const Floats points[] = {__builtin_shufflevector(xy_low, z_low, 0, 1, 4, 5),
                           __builtin_shufflevector(xy_low, z_low, 2, 3, 6, 7),
                           __builtin_shufflevector(xy_high, z_high, 0, 1, 4, 5),
                           __builtin_shufflevector(xy_high, z_high, 2, 3, 6, 7)};
  for (const Floats& point : points) {
    std::memcpy(to, &point, bytes);
    to += point_step;
  }
}

}  // namespace

/// A range of columns of one beam that does not wrap around the end of the scan.
struct RangeProjection::Run {
  std::uint32_t beam;
  std::uint32_t first;
  std::uint32_t count;
  const std::uint32_t* ranges;
  std::uint8_t* xyz;
  std::size_t point_step;
};

RangeProjection::RangeProjection(const SensorModel& model) {
  beam_origin_m_ =
      static_cast<float>(model.beam_to_lidar_z_m == 0.0
                             ? model.beam_to_lidar_x_m
                             : std::hypot(model.beam_to_lidar_x_m, model.beam_to_lidar_z_m));
  for (const Beam& b : model.beams) {
    const double azimuth = -Radians(b.azimuth_deg);
    const double altitude = Radians(b.altitude_deg);
    beams_.push_back({static_cast<float>(std::cos(azimuth) * std::cos(altitude)),
                      static_cast<float>(std::sin(azimuth) * std::cos(altitude)),
                      static_cast<float>(std::sin(altitude))});
  }
  const Transform& t = model.lidar_to_sensor;
  columns_.resize(model.columns_per_scan);
  for (std::uint32_t m = 0; m < model.columns_per_scan; ++m) {
    const double encoder = 2 * kPi - 2 * kPi * m / model.columns_per_scan;
    const double c = std::cos(encoder);
    const double s = std::sin(encoder);
    Column& column = columns_[m];
    for (std::size_t row = 0; row < 3; ++row) {
      const double* in = &t[row * 4];
      column.rotation[row * 3] = static_cast<float>(in[0] * c + in[1] * s);
      column.rotation[row * 3 + 1] = static_cast<float>(in[1] * c - in[0] * s);
      column.rotation[row * 3 + 2] = static_cast<float>(in[2]);
      column.offset[row] = static_cast<float>(model.beam_to_lidar_x_m * (in[0] * c + in[1] * s) +
                                              model.beam_to_lidar_z_m * in[2] + in[3]);
    }
  }
  for (const Column& column : columns_) {
    for (std::size_t i = 0; i < column.rotation.size(); ++i)
      numbers_[i].push_back(column.rotation[i]);
    for (std::size_t i = 0; i < column.offset.size(); ++i)
      numbers_[column.rotation.size() + i].push_back(column.offset[i]);
  }
}

std::array<float, 3> RangeProjection::Direction(std::uint32_t beam, std::uint32_t column) const {
  return Apply(columns_[column].rotation, beams_[beam]);
}

std::array<float, 3> RangeProjection::Point(std::uint32_t beam, std::uint32_t column,
                                            std::uint32_t range_mm) const {
  if (range_mm == 0) return {0, 0, 0};
  const Vector d = Direction(beam, column);
  const Vector& o = columns_[column].offset;
  const float r = static_cast<float>(range_mm) * kMetresPerMm - beam_origin_m_;
  return {r * d[0] + o[0], r * d[1] + o[1], r * d[2] + o[2]};
}

double RangeProjection::RangeOf(std::uint32_t beam, std::uint32_t column, const float* xyz) const {
  const Vector d = Direction(beam, column);
  const Vector& o = columns_[column].offset;
  const float along = (xyz[0] - o[0]) * d[0] + (xyz[1] - o[1]) * d[1] + (xyz[2] - o[2]) * d[2];
  return 1e3 * static_cast<double>(along + beam_origin_m_);
}

/// Computes the same points as Point(), but four columns at a time.
template <bool kBehind>
void RangeProjection::ProjectRun(const Run& run, const std::uint32_t* behind) const {
  constexpr std::uint32_t kAtOnce = 4;
  constexpr std::size_t kBytes = kBehind ? sizeof(Floats) : sizeof(Vector);
  const Vector& b = beams_[run.beam];
  std::uint8_t* xyz = run.xyz;
  std::uint32_t i = 0;
  for (; i + kAtOnce <= run.count; i += kAtOnce, xyz += kAtOnce * run.point_step) {
    const auto number = [&](std::size_t k) { return Load<Floats>(&numbers_[k][run.first + i]); };
    const Ints range = Load<Ints>(run.ranges + i);
    const Floats r = __builtin_convertvector(range, Floats) * kMetresPerMm - beam_origin_m_;
    const Ints is_return = range != 0;
    Floats p[3];
    for (std::size_t row = 0; row < 3; ++row) {
      const Floats direction =
          number(row * 3) * b[0] + number(row * 3 + 1) * b[1] + number(row * 3 + 2) * b[2];
      p[row] = r * direction + number(9 + row);
      const Ints kept = Load<Ints>(&p[row]) & is_return;
      std::memcpy(&p[row], &kept, sizeof kept);
    }
    const Floats last = kBehind ? Load<Floats>(behind + i) : Floats{};
    StorePoints(p[0], p[1], p[2], last, kBytes, xyz, run.point_step);
  }
  for (; i < run.count; ++i, xyz += run.point_step) {
    const Vector p = Point(run.beam, run.first + i, run.ranges[i]);
    std::memcpy(xyz, p.data(), sizeof p);
    if (kBehind) std::memcpy(xyz + sizeof p, behind + i, sizeof *behind);
  }
}

void RangeProjection::ProjectBeam(std::uint32_t beam, const std::uint32_t* ranges,
                                  ColumnWindow window, const std::uint32_t* behind,
                                  std::uint8_t* xyz, std::size_t point_step) const {
  std::uint32_t first = window.first % columns();
  for (std::uint32_t done = 0; done < window.count;) {
    const std::uint32_t count = std::min(window.count - done, columns() - first);
    const Run run{beam, first, count, ranges + done, xyz + point_step * done, point_step};
    if (behind != nullptr) {
      ProjectRun<true>(run, behind + done);
    } else {
      ProjectRun<false>(run, nullptr);
    }
    done += count;
    first = 0;
  }
}

void RangeProjection::Project(const std::uint32_t* ranges, ColumnWindow window, std::uint8_t* xyz,
                              std::size_t point_step) const {
  for (std::uint32_t beam = 0; beam < beams(); ++beam) {
    ProjectBeam(beam, ranges, window, nullptr, xyz, point_step);
    ranges += window.count;
    xyz += window.count * point_step;
  }
}

}  // namespace lidar
