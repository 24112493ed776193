// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds records in a file. Their contents are not checked.
#pragma once
#include <cstdint>
#include <optional>

#include "src/mcap/records.h"

namespace lidar::mcap {

/// A file that can be read at any offset.
class Input {
 public:
  virtual ~Input() = default;
  virtual std::uint64_t size() const = 0;
  /// Reads `n` bytes at `offset`. Returns false if it cannot read all of them.
  virtual bool Read(std::uint64_t offset, std::size_t n, std::uint8_t* to) = 0;
};

/// The limits for sizes in a file.
constexpr std::uint64_t kMaxChunk = std::uint64_t{128} << 20;    // bytes, uncompressed
constexpr std::uint64_t kMaxSummary = std::uint64_t{64} << 20;   // bytes
constexpr std::uint64_t kMaxCatalogue = std::uint64_t{8} << 20;  // bytes of schemas and channels

/// The position of a record in the file.
struct RecordPlace {
  Op op = Op::kHeader;
  std::uint64_t content = 0;  // offset of the content
  std::uint64_t size = 0;     // size of the content

  std::uint64_t end() const { return content + size; }
};

/// Returns the position of the record at `offset`, or nothing if the record extends past the end of
/// the file.
std::optional<RecordPlace> RecordAt(Input* input, std::uint64_t offset);
/// Reads the content of a record, or only its first `most` bytes. Returns false if reading failed.
bool ReadContent(Input* input, const RecordPlace& record, std::uint64_t most, Bytes* out);
/// Returns true if the magic is at `offset`.
bool HasMagic(Input* input, std::uint64_t offset);

}  // namespace lidar::mcap
