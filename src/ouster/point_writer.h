// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the columns of a packet to points.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/cloud/point_fields.h"
#include "src/cloud/range_projection.h"
#include "src/ouster/lidar_packet.h"
#include "src/ouster/mask_image.h"
#include "src/ouster/metadata.h"
#include "src/ouster/pixel_projection.h"

namespace lidar::ouster {

enum class Return { kStrongest, kSecond, kBoth };
enum class Invalid { kZero, kNan };

/// A span of azimuth in the sensor frame [degrees, from x towards y, so counter-clockwise seen from
/// above]; it wraps if the last angle is below the first.
struct Sector {
  double first_deg = 0;
  double last_deg = 360;
};

struct PointOptions {
  Return returns = Return::kStrongest;
  std::vector<std::string> channels;  // in the form of ParseChannels()
  double min_range_m = 0;
  double max_range_m = 0;                // 0: no limit
  std::vector<Sector> sectors;           // empty: all
  std::vector<std::uint8_t> mask_image;  // a file for ParseMaskImage; empty: keep all
  Invalid invalid = Invalid::kZero;
  bool destagger = false;  // only for slices of a whole scan
};

/// Parses "reflectivity, ring". Returns nothing and sets `error` for an unknown channel. Doubled
/// names count once.
std::optional<std::vector<std::string>> ParseChannels(std::string_view text, std::string* error);

/// Reads "0-90,270-360" [degrees].
std::optional<std::vector<Sector>> ParseSectors(std::string_view text);

/// A point is x, y, z, intensity (F32, intensity being the reflectivity), range (U32, mm), then the
/// second return and the extra channels. A pixel without a return has zeros (or NaN) for its
/// geometry and intensity; extra channels keep what the sensor measured (ambient light needs no
/// return).
class PointWriter {
 public:
  /// Returns nothing and sets `error` if the profile lacks something that the options ask for.
  static std::optional<PointWriter> Create(const Metadata& metadata, const PointOptions& options,
                                           std::string* error);

  const PointFields& fields() const { return fields_; }
  std::uint32_t point_step() const { return point_step_; }

  struct Target {
    std::uint8_t* points = nullptr;  // of the slice, zeroed
    std::uint32_t width = 0;         // columns of the slice
    std::uint32_t first_column = 0;
    std::uint64_t start = 0;  // time of the slice's first column [ns]
  };
  /// Writes one valid column that lies in the slice.
  void WriteColumn(const PacketColumn& column, const Target& target) const;
  /// Fills points with missing returns.
  void FillMissing(std::vector<std::uint8_t>* points) const;

 private:
  struct Extra {
    enum class Kind { kPixel, kRing, kTime } kind;
    std::optional<ChannelReader> reader;
    std::uint32_t offset;
  };

  PointWriter() = default;
  bool ChooseFields(const PointOptions& options, std::string* error);
  bool SetFilters(const PointOptions& options, const Metadata& metadata, std::string* error);
  bool AddExtra(const std::string& name, bool second);
  void MaskSectors(const std::vector<Sector>& sectors);
  bool Keeps(std::uint32_t beam, std::uint32_t column, std::uint32_t range_mm) const;
  void WritePixel(const PacketColumn& column, const Target& target, std::uint32_t beam,
                  std::uint8_t* point) const;
  void WriteExtras(const PacketColumn& column, const Target& target, std::uint32_t beam,
                   std::uint8_t* point) const;

  PacketFormat format_;
  std::uint32_t pixel_size_ = 0;
  std::uint32_t columns_ = 0;
  PointFields fields_;
  std::uint32_t point_step_ = 0;
  std::shared_ptr<const PixelProjection> projection_;
  std::optional<ChannelReader> range_;
  std::optional<ChannelReader> intensity_;
  std::optional<ChannelReader> range2_;  // of the second return, if both are wanted
  std::optional<ChannelReader> intensity2_;
  std::vector<Extra> extras_;
  std::uint32_t min_range_mm_ = 0;
  std::uint32_t max_range_mm_ = 0;
  PixelMask mask_;                     // sectors included; empty: keep all
  std::vector<std::uint32_t> shifts_;  // columns to the right, for each beam; may be empty
  Invalid invalid_ = Invalid::kZero;
};

}  // namespace lidar::ouster
