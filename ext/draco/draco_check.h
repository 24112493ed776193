// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks a Draco stream before libdraco decodes it, because libdraco trusts the numbers in it.
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
  std::uint32_t max_components = 4;  // numbers in a value of an attribute
  // Allows metadata of the cloud, but only a few entries, and no nested metadata.
  bool metadata = false;
};

/// Returns the summary of a point cloud that libdraco can decode in bounded time and memory.
/// Returns nothing for any other stream. The stream may still be damaged.
std::optional<DracoSummary> CheckDraco(ByteView stream, const DracoLimits& limits);

}  // namespace lidar::draco
