// SPDX-License-Identifier: LGPL-2.1-or-later
// The records of one chunk, uncompressed.
#pragma once
#include <optional>

#include "src/mcap/file_index.h"

namespace lidar::mcap {

/// Returns the header of the chunk at `record`; nothing if it is damaged or claims more than
/// kMaxChunk.
std::optional<ChunkHeader> ReadChunkHeader(Input* input, const RecordPlace& record);

/// Replaces `records` by those of the chunk. Returns false if the chunk is damaged.
bool ReadChunk(Input* input, const ChunkPlace& chunk, Bytes* records);

}  // namespace lidar::mcap
