// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes the intensities of points that come cell by cell.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "src/codec/cloud/cell_list.h"
#include "src/codec/cloud/node_map.h"

namespace lidar::codec::cloud {

/// Codes `levels` of 1 to 8 `bits`: one level for each point of `cells`. Within a cell the levels
/// rise. Returns false for a damaged stream.
template <class Coder>
bool CodeLevels(const CellList& cells, unsigned bits, std::vector<std::uint8_t>* levels,
                Coder* coder);

}  // namespace lidar::codec::cloud
