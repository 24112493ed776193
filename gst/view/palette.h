// SPDX-License-Identifier: LGPL-2.1-or-later
// Numbers to colours.
#pragma once
#include "gst/view/canvas.h"

namespace lidar::gst {

/// Colours from cold to warm for 0 .. 1; what lies outside gets the colour of the end.
Color Spectrum(float t);
/// Colours from slate to warm white, for brightness.
Color Glow(float t);

/// `part` of the way from `a` to `b`.
Color Mix(Color a, Color b, float part);

}  // namespace lidar::gst
