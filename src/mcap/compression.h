// SPDX-License-Identifier: LGPL-2.1-or-later
// Compresses chunks by lz4 or zstd, in the frame formats of the MCAP specification.
#pragma once
#include <string_view>

#include "src/mcap/records.h"

namespace lidar::mcap {

enum class Compression { kNone, kLz4, kZstd };

/// Returns the name that a chunk's header has for `compression`.
std::string_view NameOf(Compression compression);

/// Replaces `out` by the compressed `bytes`. Returns false if this saves less than a twentieth of
/// the size. The caller should then store `bytes` uncompressed.
bool Compress(Compression compression, ByteView bytes, Bytes* out);

/// Replaces `out` by the uncompressed `bytes`. Returns false if `bytes` are damaged, if their
/// uncompressed size is not `size`, or if the compression is unknown. The caller has limited
/// `size`.
bool Decompress(std::string_view compression, ByteView bytes, std::size_t size, Bytes* out);

}  // namespace lidar::mcap
