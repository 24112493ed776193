// SPDX-License-Identifier: LGPL-2.1-or-later
// Encodes and decodes the slices of one stream with Draco, as ranges or as xyz.
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
  unsigned level = 7;  // Draco's compression level; only for xyz
};

/// Encodes slices as plain Draco files. Only one thread at a time may use it.
class XyzSliceEncoder {
 public:
  explicit XyzSliceEncoder(const codec::CloudLayout& layout) : layout_(layout) {}

  void Load(ByteView raw, bool with_intensity);
  const XyzCloud& cloud() const { return cloud_; }
  bool has_intensity() const { return has_intensity_; }
  void Thin(const std::vector<bool>& kept);
  codec::SliceResult Encode(const SliceSettings& settings, codec::EncodedSlice* slice);
  /// Copies two things from `before`: which method was better, and how many slices remain until
  /// both methods are tried again.
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
  // The number of slices with a level above 0. Every kTryBothEvery-th of them tries both methods.
  unsigned slices_ = 0;
};

/// Encodes slices like codec::SliceEncoder, but also supports xyz geometry and Draco's coders. Only
/// one thread at a time may use it.
class SliceEncoder {
 public:
  /// Returns nothing if `format` cannot be coded with this geometry. If `geometry` is empty, kRange
  /// is used if `format` allows it.
  static std::optional<SliceEncoder> Create(const codec::CloudFormat& format,
                                            std::optional<Geometry> geometry,
                                            codec::RangeCoder coder = codec::RangeCoder::kAdaptive);

  Geometry geometry() const { return range_ ? Geometry::kRange : Geometry::kXyz; }

  /// Loads the points of `raw` for Encode(). `raw` must have whole points, and whole beams for
  /// kRange.
  void Load(ByteView raw, std::uint32_t first_column, bool with_intensity);
  /// Returns how many LiDAR returns the loaded slice has.
  std::size_t returns() const { return range_ ? range_->returns() : xyz_.cloud().size(); }
  /// Returns the longest range, or the longest side of the bounding box of the points [m].
  double extent_m() const { return range_ ? range_->extent_m() : LongestSide(xyz_.cloud()); }
  /// Returns the resolution of the loaded ranges [mm], or 1 if there are none.
  std::uint32_t range_unit_mm() const { return range_ ? range_->range_unit_mm() : 1; }
  bool has_intensity() const { return range_ ? range_->has_intensity() : xyz_.has_intensity(); }
  /// Returns the name of the coder that Encode() will use, for example "xyz-kd6". The name is used
  /// in statistics and by predictors.
  std::string Mode(unsigned level) const;

  /// Keeps only the loaded beams (kRange) or points (kXyz) that are true in `kept`.
  void Thin(const std::vector<bool>& kept);
  /// Returns the number of beams or points among which Thin() selects.
  std::size_t rows() const { return range_ ? range_->rows() : xyz_.cloud().size(); }

  /// Like in codec::SliceEncoder. Has no effect in xyz geometry.
  void set_threads(unsigned threads);
  void set_effort(unsigned effort);

  /// Encodes the loaded points. May be called several times for the same points.
  codec::SliceResult Encode(const SliceSettings& settings, codec::EncodedSlice* slice);
  /// Continues the stream of `before`, whose format was different. Copies what `before` found out
  /// about Draco's methods.
  void Continue(const SliceEncoder& before) { xyz_.Continue(before.xyz_); }

 private:
  explicit SliceEncoder(const codec::CloudLayout& layout) : xyz_(layout) {}

  std::optional<codec::SliceEncoder> range_;
  XyzSliceEncoder xyz_;  // only used if `range_` is empty
};

/// Decodes the slices of one stream. Any bytes may be passed to it. Only one thread at a time may
/// use it.
class SliceDecoder {
 public:
  using Shape = codec::SliceDecoder::Shape;
  using Quality = codec::SliceDecoder::Quality;

  /// If the geometry is kRange, `format` must have a sensor model.
  SliceDecoder(const codec::CloudFormat& format, Geometry geometry, std::uint32_t max_points);

  /// Decodes a slice for Write(). Returns nothing if the stream is damaged, comes from another
  /// sensor, or has more than max_points points.
  std::optional<Shape> Decode(ByteView stream);
  /// Returns the quality of the slice that was decoded last. It is not known for xyz, because a
  /// plain Draco file does not contain it.
  Quality quality() const { return range_ ? range_->quality() : Quality{}; }
  /// Writes the decoded slice as width * height points.
  void Write(std::uint8_t* raw) const;

 private:
  codec::CloudLayout layout_;
  std::uint32_t max_points_;
  std::optional<codec::SliceDecoder> range_;
  XyzCloud cloud_;
};

}  // namespace lidar::draco
