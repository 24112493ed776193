// SPDX-License-Identifier: LGPL-2.1-or-later
// Chunks compressed by lz4 or zstd, in the frame formats that MCAP names.
#pragma once
#include <string_view>

#include "src/mcap/records.h"

namespace lidar::mcap {

enum class Compression { kNone, kLz4, kZstd };

/// Returns the name of `compression` in a chunk's header.
std::string_view NameOf(Compression compression);

/// Replaces `out` by the compressed `bytes`. Returns false if this saves less than a twentieth,
/// because then `bytes` are better stored uncompressed.
bool Compress(Compression compression, ByteView bytes, Bytes* out);

/// Replaces `out` by the uncompressed `bytes`. Returns false if `bytes` are damaged, do not give
/// exactly `size` bytes, or have an unknown compression. The caller has bounded `size`.
bool Decompress(std::string_view compression, ByteView bytes, std::size_t size, Bytes* out);

}  // namespace lidar::mcap
