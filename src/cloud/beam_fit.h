// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the beams of a spinning sensor in its organised clouds, where nobody says what they are.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/cloud/sensor_model.h"

namespace lidar {

/// Rows are beams and columns are steps of the encoder, in either direction. A beam's points lie on
/// a line once the encoder is turned back, and the lines of all beams meet in the beams' origin.
class BeamFit {
 public:
  BeamFit(std::uint32_t width, std::uint32_t height) : width_(width), beams_(height) {}

  /// x, y and z [m] of point i stand as F32 at `xyz + i * point_step`, row by row.
  void Add(const std::uint8_t* xyz, std::size_t point_step);

  /// The model that fits all that was added best. Whether it fits well, its user finds out point by
  /// point. None where there are too few returns, or columns do not turn evenly.
  std::optional<SensorModel> Fit() const;

 private:
  using Vector = std::array<double, 3>;
  /// Sums over the points of a beam, with the encoder turned back.
  struct Moments {
    double count = 0;
    Vector sum{};
    std::array<double, 9> products{};  // row-major
  };
  struct Lines {
    Vector origin{};
    std::vector<Vector> directions;
  };

  bool FindTurn(const std::uint8_t* xyz, std::size_t point_step);
  static Vector DirectionOf(const Moments& m, const Vector& origin, const Vector& guess);
  static std::optional<Vector> OriginOf(const std::vector<Moments>& beams,
                                        const std::vector<Vector>& directions);
  Lines FitLines() const;
  void FillGaps(std::vector<Beam>* beams) const;

  std::uint32_t width_;
  std::uint32_t columns_per_turn_ = 0;  // 0: not known yet
  bool counter_clockwise_ = false;
  std::vector<Moments> beams_;
};

}  // namespace lidar
