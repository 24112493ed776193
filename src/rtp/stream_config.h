// SPDX-License-Identifier: LGPL-2.1-or-later
// The stream-config unit. A receiver needs it before it can decode slices.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/scalar_caps.h"
#include "src/cloud/coded_geometry.h"

namespace lidar::rtp {

/// The coder of the slices. The numbers are part of the wire format. Coders without a number are
/// kNamed, and are identified by their caps.
enum class Coder : std::uint8_t { kDraco = 0, kLidar = 1, kNamed = 15 };

struct StreamConfig {
  Coder coder = Coder::kDraco;
  ScalarCaps caps;  // only for kNamed, which has no other fields
  Geometry geometry = Geometry::kXyz;
  std::uint32_t framerate_n = 0;  // scans/s; 0/1 if not known
  std::uint32_t framerate_d = 1;
  std::string fields;                      // as in the caps, and validated
  std::vector<std::uint8_t> sensor_model;  // serialised and validated; may be empty

  std::vector<std::uint8_t> Serialise() const;
  /// Returns nothing if the version or the coder is unknown, if the length is wrong, or if the
  /// sensor model is invalid. Also returns nothing for fields that no decoder produces: they must
  /// be packed, with x, y and z as adjacent F32. The caps of kNamed must have alignment=slice, and
  /// a media type that does not belong to this project.
  static std::optional<StreamConfig> Parse(ByteView bytes);
  bool operator==(const StreamConfig& o) const;
  bool operator!=(const StreamConfig& o) const { return !(*this == o); }
};

/// Returns an id for `config`. The id depends on the content, so that a restarted sender uses the
/// same id. It differs from `previous`, the id of the last config.
std::uint8_t ConfigId(const std::vector<std::uint8_t>& config,
                      std::optional<std::uint8_t> previous);

}  // namespace lidar::rtp
