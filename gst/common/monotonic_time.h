// SPDX-License-Identifier: LGPL-2.1-or-later
// The system clock, for times that do not come from a pipeline clock.
#pragma once
#include <glib.h>

#include "src/base/time.h"

namespace lidar::gst {

inline Time MonotonicTime() { return Time{std::chrono::microseconds(g_get_monotonic_time())}; }

}  // namespace lidar::gst
