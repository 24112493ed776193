// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the records of a chunk and uncompresses them.
#pragma once
#include <optional>

#include "src/mcap/file_index.h"

namespace lidar::mcap {

/// Returns the header of the chunk at `record`. Returns nothing if the header is damaged, or if it
/// claims more than kMaxChunk bytes.
std::optional<ChunkHeader> ReadChunkHeader(Input* input, const RecordPlace& record);

/// Replaces the contents of `records` by the records of the chunk. Returns false if the chunk is
/// damaged.
bool ReadChunk(Input* input, const ChunkPlace& chunk, Bytes* records);

}  // namespace lidar::mcap
