// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts numbers to colours.
#pragma once
#include "gst/view/canvas.h"

namespace lidar::gst {

/// Colours from cold to warm for 0 .. 1; other values get the colour of the nearest end.
Color Spectrum(float t);
/// Colours from slate to warm white, for brightness.
Color Glow(float t);

/// Mixes `a` and `b`; `part` is the share of `b`.
Color Mix(Color a, Color b, float part);

}  // namespace lidar::gst
