// SPDX-License-Identifier: LGPL-2.1-or-later
// The ground of a town: hills, and a plan of straight streets that is bent into curves.
#pragma once
#include <cstdint>

namespace lidar::synth {

/// Returns the remainder of a phase after whole periods. This is faster than with floor().
template <class T>
T Fraction(T phase) {
  const T rest = phase - static_cast<T>(static_cast<std::int32_t>(phase));
  return rest < 0 ? rest + 1 : rest;
}

/// Returns a wave of parabolas with period 1 and amplitude 1. It is as smooth as roads are, and its
/// curvature is known.
template <class T>
T Arch(T phase) {
  const T t = Fraction(phase);
  return t < T(0.5) ? 16 * t * (T(0.5) - t) : -16 * (t - T(0.5)) * (1 - t);
}
template <class T>
T ArchSlope(T phase) {
  const T t = Fraction(phase);
  return t < T(0.5) ? 8 - 32 * t : 32 * t - 24;
}
constexpr float kArchCurvature = 32;

struct Bend {
  double amplitude_m;
  double length_m;
  double At(double where) const { return amplitude_m * Arch(where / length_m); }
  double SlopeAt(double where) const {
    return amplitude_m / length_m * ArchSlope(where / length_m);
  }
};

// The lengths have no common divisor with the distance between crossings, so that blocks differ.
// Grades are at most 10 % along each axis, and curves have radii of at least 350 m.
constexpr Bend kHillX{5, 421};
constexpr Bend kHillY{4, 347};
constexpr Bend kBendU{20, 521};  // shift of u along y
constexpr Bend kBendV{17, 463};  // shift of v along x

/// Converts between the coordinates x, y of the world and u, v of the plan. In the plan, streets
/// are straight.
class Terrain {
 public:
  struct Point {
    double a = 0;  // x or u
    double b = 0;  // y or v
  };
  static Point ToPlan(Point world);
  static Point FromPlan(Point plan);
  /// Returns the direction that a street has at `world`. The street runs along u or along v. The
  /// length of the direction is not 1.
  static Point DirectionAt(Point world, bool along_u);

  struct Ground {
    double height = 0;
    double slope_x = 0;
    double slope_y = 0;
  };
  static Ground At(Point world);

  /// The terrain around an anchor. Coordinates are relative to the anchor, so that floats are
  /// precise enough.
  class Local {
   public:
    Local(double anchor_x, double anchor_y)
        : hill_x_(kHillX, anchor_x),
          hill_y_(kHillY, anchor_y),
          bend_x_(kBendV, anchor_x),
          bend_y_(kBendU, anchor_y) {}
    struct Height {
      float z, slope_x, slope_y;
    };
    Height HeightAt(float x, float y) const {
      return {hill_x_.At(x) + hill_y_.At(y), hill_x_.SlopeAt(x), hill_y_.SlopeAt(y)};
    }
    /// PlanU() and PlanV() return the plan coordinates of a point, minus the coordinates that the
    /// anchor has in the world.
    float PlanU(float x, float y) const { return x - bend_y_.At(y); }
    float PlanV(float x, float y) const { return y - bend_x_.At(x); }
    static constexpr float curvature() {  // greatest curvature of the ground [1/m]
      return kArchCurvature *
             static_cast<float>(kHillY.amplitude_m / (kHillY.length_m * kHillY.length_m));
    }

   private:
    struct NearBend {
      NearBend(const Bend& bend, double anchor)
          : amplitude(static_cast<float>(bend.amplitude_m)),
            per_m(static_cast<float>(1 / bend.length_m)),
            phase(static_cast<float>(Fraction(anchor / bend.length_m))) {}
      float At(float where) const { return amplitude * Arch(phase + where * per_m); }
      float SlopeAt(float where) const {
        return amplitude * per_m * ArchSlope(phase + where * per_m);
      }
      float amplitude, per_m, phase;
    };
    NearBend hill_x_, hill_y_, bend_x_, bend_y_;
  };
};

}  // namespace lidar::synth
