// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks a Draco stream before it goes to libdraco, which trusts the counts in it.
#pragma once
#include <cstdint>
#include <optional>

#include "src/base/byte_reader.h"

namespace lidar::draco {

struct DracoSummary {
  std::uint32_t points = 0;
  bool is_kd_tree = false;
};

struct DracoLimits {
  std::uint32_t max_points = 0;
  std::uint32_t max_attributes = 8;
  std::uint32_t max_components = 4;  // numbers of an attribute
  bool metadata = false;             // allows metadata of the cloud: a few entries, not nested
};

/// Returns the summary of a point cloud that libdraco decodes in bounded time and memory, else
/// nothing. The stream may still be damaged.
std::optional<DracoSummary> CheckDraco(ByteView stream, const DracoLimits& limits);

}  // namespace lidar::draco
