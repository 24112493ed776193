// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes the intensities of points that are sorted by cells.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "src/codec/cloud/cell_list.h"
#include "src/codec/cloud/node_map.h"

namespace lidar::codec::cloud {

/// Codes `levels`: one level of 1 to 8 `bits` for each point of `cells`. The levels of a cell are
/// in ascending order. Returns false if the stream is damaged.
template <class Coder>
bool CodeLevels(const CellList& cells, unsigned bits, std::vector<std::uint8_t>* levels,
                Coder* coder);

}  // namespace lidar::codec::cloud
