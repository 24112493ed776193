// SPDX-License-Identifier: LGPL-2.1-or-later
// Encodes and decodes the raw slices of one stream with Draco, in the geometry chosen for it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ext/draco/xyz_codec.h"
#include "src/cloud/coded_geometry.h"
#include "src/codec/slice_decoder.h"
#include "src/codec/slice_encoder.h"

namespace lidar::draco {

struct SliceSettings : codec::SliceSettings {
  unsigned level = 7;  // Draco's compression level, for xyz
};

/// Slices as plain Draco files. For one thread at a time.
class XyzSliceEncoder {
 public:
  explicit XyzSliceEncoder(const codec::CloudLayout& layout) : layout_(layout) {}

  void Load(ByteView raw, bool with_intensity);
  const XyzCloud& cloud() const { return cloud_; }
  bool has_intensity() const { return has_intensity_; }
  void Thin(const std::vector<bool>& kept);
  codec::SliceResult Encode(const SliceSettings& settings, codec::EncodedSlice* slice);
  /// Takes over from `before` the better method, and the number of slices until both are tried
  /// again.
  void Continue(const XyzSliceEncoder& before) {
    method_ = before.method_;
    slices_ = before.slices_;
  }

 private:
  bool TryBothMethods(const XyzSettings& settings, codec::EncodedSlice* slice, XyzResult* result);

  codec::CloudLayout layout_;
  XyzCloud cloud_;
  bool has_intensity_ = false;
  XyzMethod method_ = XyzMethod::kKdTree;
  unsigned slices_ = 0;  // slices with a level above 0; every kTryBothEvery-th tries both methods
};

/// Encodes slices as codec::SliceEncoder does, and also in xyz geometry and with Draco's coders.
/// For one thread at a time.
class SliceEncoder {
 public:
  /// Returns nothing if `format` cannot be coded in that geometry. Without a geometry it takes
  /// kRange if `format` allows it.
  static std::optional<SliceEncoder> Create(const codec::CloudFormat& format,
                                            std::optional<Geometry> geometry,
                                            codec::RangeCoder coder = codec::RangeCoder::kAdaptive);

  Geometry geometry() const { return range_ ? Geometry::kRange : Geometry::kXyz; }

  /// Loads the points of `raw`, which holds whole points (range: whole beams) of the format, for
  /// Encode().
  void Load(ByteView raw, std::uint32_t first_column, bool with_intensity);
  /// The number of loaded returns.
  std::size_t returns() const { return range_ ? range_->returns() : xyz_.cloud().size(); }
  /// Longest range, or longest side of the points' box [m].
  double extent_m() const { return range_ ? range_->extent_m() : LongestSide(xyz_.cloud()); }
  /// Resolution of the loaded ranges [mm]; 1 if there are none.
  std::uint32_t range_unit_mm() const { return range_ ? range_->range_unit_mm() : 1; }
  bool has_intensity() const { return range_ ? range_->has_intensity() : xyz_.has_intensity(); }
  /// Returns the name of the coder that Encode() will use, for statistics and predictors:
  /// "xyz-kd6".
  std::string Mode(unsigned level) const;

  /// Keeps only the loaded beams (range) or points (xyz) that `kept` marks.
  void Thin(const std::vector<bool>& kept);
  /// The number of beams or points that Thin() chooses from.
  std::size_t rows() const { return range_ ? range_->rows() : xyz_.cloud().size(); }

  /// As in codec::SliceEncoder; has no effect in xyz geometry.
  void set_threads(unsigned threads);
  void set_effort(unsigned effort);

  /// Encodes the loaded points. May be called again for the same ones.
  codec::SliceResult Encode(const SliceSettings& settings, codec::EncodedSlice* slice);
  /// Takes over what the encoder of the stream's previous format measured about the methods.
  void Continue(const SliceEncoder& before) { xyz_.Continue(before.xyz_); }

 private:
  explicit SliceEncoder(const codec::CloudLayout& layout) : xyz_(layout) {}

  std::optional<codec::SliceEncoder> range_;
  XyzSliceEncoder xyz_;  // used if there is no `range_`
};

/// Decodes the slices of one stream; any bytes give a cloud or nothing. For one thread at a time.
class SliceDecoder {
 public:
  using Shape = codec::SliceDecoder::Shape;
  using Quality = codec::SliceDecoder::Quality;

  /// kRange needs a sensor model.
  SliceDecoder(const codec::CloudFormat& format, Geometry geometry, std::uint32_t max_points);

  /// Decodes a slice and keeps it for Write(). Returns nothing for a stream that is damaged, of
  /// another sensor, or larger than max_points.
  std::optional<Shape> Decode(ByteView stream);
  /// The quality of the slice decoded last; unknown for xyz, which is a plain Draco file.
  Quality quality() const { return range_ ? range_->quality() : Quality{}; }
  /// Writes width * height points of the format.
  void Write(std::uint8_t* raw) const;

 private:
  codec::CloudLayout layout_;
  std::uint32_t max_points_;
  std::optional<codec::SliceDecoder> range_;
  XyzCloud cloud_;
};

}  // namespace lidar::draco
