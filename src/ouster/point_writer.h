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

/// An interval of azimuths in the sensor frame [degrees]. Azimuths grow from x towards y, which is
/// counter-clockwise if seen from above. If `last_deg` is less than `first_deg`, the sector
/// contains 0 degrees.
struct Sector {
  double first_deg = 0;
  double last_deg = 360;
};

struct PointOptions {
  Return returns = Return::kStrongest;
  std::vector<std::string> channels;  // as returned by ParseChannels()
  double min_range_m = 0;
  double max_range_m = 0;                // 0 for no limit
  std::vector<Sector> sectors;           // empty: keep all azimuths
  std::vector<std::uint8_t> mask_image;  // the bytes of a PGM file; empty: keep all pixels
  Invalid invalid = Invalid::kZero;
  bool destagger = false;  // only if a slice is a whole scan
};

/// Parses a list of names such as "reflectivity, ring". Returns nothing and sets `error` if a
/// channel is unknown. A name that is listed twice is used once.
std::optional<std::vector<std::string>> ParseChannels(std::string_view text, std::string* error);

/// Parses a list of sectors such as "0-90,270-360" [degrees].
std::optional<std::vector<Sector>> ParseSectors(std::string_view text);

/// Writes the points of a cloud. A point has the fields x, y, z and intensity (F32; the intensity
/// is the reflectivity) and range (U32, mm), followed by the second return and the extra channels.
/// If a pixel has no return, its intensity is 0, and its geometry is 0 or NaN. Its extra channels
/// still have the values that the sensor measured, because for example ambient light is measured
/// without a return.
class PointWriter {
 public:
  /// Returns nothing and sets `error` if the options need a channel that the profile does not have.
  static std::optional<PointWriter> Create(const Metadata& metadata, const PointOptions& options,
                                           std::string* error);

  const PointFields& fields() const { return fields_; }
  std::uint32_t point_step() const { return point_step_; }

  struct Target {
    std::uint8_t* points = nullptr;  // the zeroed points of the slice
    std::uint32_t width = 0;         // number of columns in the slice
    std::uint32_t first_column = 0;
    std::uint64_t start = 0;  // time of the slice's first column [ns]
  };
  /// Writes the points of a column, which must be valid and belong to the slice.
  void WriteColumn(const PacketColumn& column, const Target& target) const;
  /// Sets all points to missing returns.
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
  std::optional<ChannelReader> range2_;  // reads the second return, if both returns are wanted
  std::optional<ChannelReader> intensity2_;
  std::vector<Extra> extras_;
  std::uint32_t min_range_mm_ = 0;
  std::uint32_t max_range_mm_ = 0;
  PixelMask mask_;                     // includes the sectors; empty: keep all pixels
  std::vector<std::uint32_t> shifts_;  // shift to the right [columns] of each beam; empty: none
  Invalid invalid_ = Invalid::kZero;
};

}  // namespace lidar::ouster
