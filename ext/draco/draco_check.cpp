// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/draco_check.h"

#include <cstring>

namespace lidar::draco {
namespace {

constexpr char kMagic[] = {'D', 'R', 'A', 'C', 'O'};
constexpr std::uint8_t kMajor = 2;
constexpr std::uint8_t kMinor = 3;
constexpr std::uint8_t kPointCloud = 0;
constexpr std::uint8_t kKdTree = 1;
constexpr std::uint16_t kMetadata = 0x8000;  // flag
constexpr std::uint8_t kMaxEntries = 16;     // greatest number of metadata entries
constexpr std::uint8_t kMaxDataType = 11;
constexpr std::uint8_t kMaxKdLevel = 6;
constexpr std::uint32_t kMaxBitLength = 32;

/// Reads a number of variable length. The numbers of plausible metadata have one byte, so returns
/// nothing for a longer number.
std::optional<std::uint8_t> Short(ByteReader* reader) {
  const std::uint8_t number = reader->U8();
  if (number >= 0x80) return std::nullopt;
  return number;
}

/// Skips the metadata of a cloud. Returns false for nested metadata, which libdraco would read to
/// any depth.
bool SkipMetadata(ByteReader* reader) {
  const auto of_attributes = Short(reader);
  const auto entries = Short(reader);
  if (of_attributes != 0 || !entries || *entries > kMaxEntries) return false;
  for (std::uint8_t i = 0; i < *entries; ++i) {
    reader->Skip(reader->U8());  // name
    const auto size = Short(reader);
    if (!size) return false;
    reader->Skip(*size);
  }
  return Short(reader) == 0;  // the number of nested metadata must be 0
}

bool CheckAttributes(ByteReader* reader, const DracoLimits& limits) {
  const std::uint8_t count = reader->U8();
  if (count == 0 || count > limits.max_attributes) return false;
  for (std::uint8_t i = 0; i < count; ++i) {
    reader->Skip(1);  // the meaning of the attribute
    const std::uint8_t data_type = reader->U8();
    const std::uint8_t components = reader->U8();
    reader->Skip(1);  // normalised
    const std::uint8_t id = reader->U8();
    if (data_type == 0 || data_type > kMaxDataType || components == 0 ||
        components > limits.max_components || id >= 0x80) {
      return false;
    }
  }
  return true;
}

/// Checks the header of the kd-tree. The header has the number of points a second time. If this
/// number were larger than `points`, libdraco would decode for seconds.
bool CheckKdTree(ByteReader* reader, std::uint32_t points) {
  const std::uint8_t level = reader->U8();
  const std::uint32_t bit_length = reader->Le32();
  const std::uint32_t inner = reader->Le32();
  return level <= kMaxKdLevel && bit_length >= 1 && bit_length <= kMaxBitLength && inner == points;
}

}  // namespace

std::optional<DracoSummary> CheckDraco(ByteView stream, const DracoLimits& limits) {
  ByteReader reader(stream);
  const ByteView magic = reader.Bytes(sizeof kMagic);
  if (!reader.ok() || std::memcmp(magic.data, kMagic, sizeof kMagic) != 0) return std::nullopt;
  const std::uint8_t major = reader.U8();
  const std::uint8_t minor = reader.U8();
  const std::uint8_t type = reader.U8();
  const std::uint8_t method = reader.U8();
  const std::uint16_t flags = reader.Le16();
  const bool has_metadata = limits.metadata && flags == kMetadata;
  if (has_metadata ? !SkipMetadata(&reader) : flags != 0) return std::nullopt;
  DracoSummary summary;
  summary.points = reader.Le32();
  summary.is_kd_tree = method == kKdTree;
  const std::uint8_t decoders = reader.U8();
  if (major != kMajor || minor != kMinor || type != kPointCloud || method > kKdTree ||
      summary.points == 0 || summary.points > limits.max_points || decoders != 1 ||
      !CheckAttributes(&reader, limits) ||
      (summary.is_kd_tree && !CheckKdTree(&reader, summary.points)) || !reader.ok()) {
    return std::nullopt;
  }
  return summary;
}

}  // namespace lidar::draco
