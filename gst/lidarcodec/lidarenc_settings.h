// SPDX-License-Identifier: LGPL-2.1-or-later
// What a user sets of lidarenc alone.
#pragma once
#include <array>
#include <chrono>

#include "gst/common/properties.h"
#include "src/base/time.h"

namespace lidar::gst {

enum class Reference : gint { kNothing, kAcknowledged };

struct LidarEncSettings {
  static constexpr gint kAutoEffort = -1;

  gint effort = kAutoEffort;
  Reference reference = Reference::kAcknowledged;
  Duration key_interval = std::chrono::seconds(10);
};

const std::array<Property<LidarEncSettings>, 3>& LidarEncRows();

}  // namespace lidar::gst
