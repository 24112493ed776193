// SPDX-License-Identifier: LGPL-2.1-or-later
// Constants of tests in simulated time.
#pragma once
#include "src/base/units.h"

namespace lidar {

/// The start of simulated time. It is not zero, so that it differs from an unset time.
constexpr Time kStart{std::chrono::seconds(100)};

constexpr DataRate Mbps(double megabits) { return DataRate::BitsPerSecond(megabits * 1e6); }

}  // namespace lidar
