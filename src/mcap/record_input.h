// SPDX-License-Identifier: LGPL-2.1-or-later
// Unchecked records of a file.
#pragma once
#include <cstdint>
#include <optional>

#include "src/mcap/records.h"

namespace lidar::mcap {

/// The bytes of a file, as its owner reads them.
class Input {
 public:
  virtual ~Input() = default;
  virtual std::uint64_t size() const = 0;
  /// Reads `n` bytes, or fails.
  virtual bool Read(std::uint64_t offset, std::size_t n, std::uint8_t* to) = 0;
};

/// Limits of what a file may claim.
constexpr std::uint64_t kMaxChunk = std::uint64_t{128} << 20;    // bytes, uncompressed
constexpr std::uint64_t kMaxSummary = std::uint64_t{64} << 20;   // bytes
constexpr std::uint64_t kMaxCatalogue = std::uint64_t{8} << 20;  // bytes of schemas and channels

/// Place of a record in the file.
struct RecordPlace {
  Op op = Op::kHeader;
  std::uint64_t content = 0;  // offset
  std::uint64_t size = 0;     // of the content

  std::uint64_t end() const { return content + size; }
};

/// The record at `offset`; nothing if it does not fit into the file.
std::optional<RecordPlace> RecordAt(Input* input, std::uint64_t offset);
/// Reads the content, or its first `most` bytes. Returns false if that failed.
bool ReadContent(Input* input, const RecordPlace& record, std::uint64_t most, Bytes* out);
/// Returns true if the magic stands at `offset`.
bool HasMagic(Input* input, std::uint64_t offset);

}  // namespace lidar::mcap
