// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts numbers to colours.
#pragma once
#include "gst/view/canvas.h"

namespace lidar::gst {

/// Returns a colour from cold (0) to warm (1). For other values, returns the colour of the nearer
/// end.
Color Spectrum(float t);
/// Returns the colour of the brightness `t`, from slate (0) to warm white (1).
Color Glow(float t);

/// Mixes `a` and `b`. `part` is the share of `b`.
Color Mix(Color a, Color b, float part);

}  // namespace lidar::gst
