// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes the beams of a table. Each field is predicted by the same field of earlier beams.
#pragma once
#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

/// Codes all beams of `table`, from top to bottom. The table must not have a path. Returns false if
/// the stream is damaged.
template <class Coder>
bool CodeBeams(BeamTable* table, Coder* coder);

}  // namespace lidar::codec::cloud
