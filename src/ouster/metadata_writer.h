// SPDX-License-Identifier: LGPL-2.1-or-later
// Metadata JSON for sensors that exist in software only.
#pragma once
#include <string>

#include "src/ouster/metadata.h"

namespace lidar::ouster {

/// Writes the sections of firmware 2.0 and later; ParseMetadata reads it back.
std::string WriteMetadata(const Metadata& metadata);

}  // namespace lidar::ouster
