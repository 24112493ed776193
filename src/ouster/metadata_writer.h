// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes metadata JSON for sensors that exist in software only.
#pragma once
#include <string>

#include "src/ouster/metadata.h"

namespace lidar::ouster {

/// Writes the layout with sections of firmware 2.0 and later. ParseMetadata() can read the result.
std::string WriteMetadata(const Metadata& metadata);

}  // namespace lidar::ouster
