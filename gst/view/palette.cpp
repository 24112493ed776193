// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/view/palette.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace lidar::gst {
namespace {

struct Stop {
  float r, g, b;
};

template <std::size_t N>
Color Blend(const std::array<Stop, N>& stops, float t) {
  // If `t` is NaN, the comparison is false, which results in the first colour.
  const float at = (t > 0 ? std::min(t, 1.0F) : 0.0F) * static_cast<float>(N - 1);
  const auto i = std::min(static_cast<std::size_t>(at), N - 2);
  const float f = at - static_cast<float>(i);
  const auto mix = [f](float a, float b) { return static_cast<std::uint8_t>(a + f * (b - a)); };
  return {mix(stops[i].r, stops[i + 1].r), mix(stops[i].g, stops[i + 1].g),
          mix(stops[i].b, stops[i + 1].b)};
}

}  // namespace

Color Spectrum(float t) {
  constexpr std::array<Stop, 8> kStops = {{{58, 62, 150},
                                           {52, 110, 214},
                                           {38, 170, 222},
                                           {56, 204, 164},
                                           {140, 220, 104},
                                           {240, 212, 80},
                                           {246, 142, 62},
                                           {226, 70, 62}}};
  return Blend(kStops, t);
}

Color Glow(float t) {
  constexpr std::array<Stop, 5> kStops = {
      {{34, 40, 62}, {70, 88, 128}, {134, 150, 172}, {228, 206, 168}, {255, 246, 222}}};
  return Blend(kStops, t);
}

Color Mix(Color a, Color b, float part) {
  const auto mix = [part](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(static_cast<float>(x) * (1 - part) +
                                     static_cast<float>(y) * part);
  };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

}  // namespace lidar::gst
