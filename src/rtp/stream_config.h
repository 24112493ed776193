// SPDX-License-Identifier: LGPL-2.1-or-later
// The stream-config unit: what a receiver needs before it can decode a slice.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/scalar_caps.h"
#include "src/cloud/coded_geometry.h"

namespace lidar::rtp {

/// The coder of the slices; the numbers are part of the format. Other coders are identified by
/// their caps.
enum class Coder : std::uint8_t { kDraco = 0, kLidar = 1, kNamed = 15 };

struct StreamConfig {
  Coder coder = Coder::kDraco;
  ScalarCaps caps;  // for kNamed, which uses nothing else
  Geometry geometry = Geometry::kXyz;
  std::uint32_t framerate_n = 0;  // scans/s; 0/1: not known
  std::uint32_t framerate_d = 1;
  std::string fields;                      // as in the caps, checked
  std::vector<std::uint8_t> sensor_model;  // serialised and checked; may be empty

  std::vector<std::uint8_t> Serialise() const;
  /// Returns nothing for another version or coder, a wrong length, an invalid sensor model, or
  /// fields that no decoder produces: decoders produce packed fields with x, y and z as adjacent
  /// F32. Caps of kNamed must have alignment=slice, and a media type that is not one of this
  /// project's.
  static std::optional<StreamConfig> Parse(ByteView bytes);
  bool operator==(const StreamConfig& o) const;
  bool operator!=(const StreamConfig& o) const { return !(*this == o); }
};

/// Returns the id of a config. It depends on the content, so that a restarted sender keeps its id,
/// and differs from `previous`, the id of the last config.
std::uint8_t ConfigId(const std::vector<std::uint8_t>& config,
                      std::optional<std::uint8_t> previous);

}  // namespace lidar::rtp
