// SPDX-License-Identifier: LGPL-2.1-or-later
// Encodes the raw slices of one stream in the geometry chosen for it.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ext/draco/xyz_codec.h"
#include "src/cloud/sensor_model.h"
#include "src/codec/cloud_io.h"
#include "src/codec/range_codec.h"

namespace lidar::codec {

enum class Geometry { kAuto, kXyz, kRange };

/// What the caps say of every raw slice of a stream.
struct CloudFormat {
  CloudLayout layout;
  std::uint32_t height = 1;  // beams, where the cloud is organised
  std::optional<SensorModel> sensor_model;
};

struct SliceSettings {
  double max_error_m = 0.02;  // bound of the 3D error of every point
  double step_m = 0;          // of the grid; 0: the coarsest that max_error_m allows
  unsigned intensity_bits = 0;
  unsigned level = 7;  // Draco's compression level, for xyz
};

struct EncodedSlice {
  std::vector<std::uint8_t> bytes;
  std::size_t returns = 0;
  double step_m = 0;
  double error_m = 0;  // bound that holds with this step
};

enum class SliceResult {
  kEncoded,
  kEmpty,       // nothing that this geometry could encode
  kOutOfReach,  // no grid meets max_error_m
};

/// One stream, so one format. For one thread at a time.
class SliceEncoder {
 public:
  /// None where `format` cannot be coded in that geometry; kAuto takes kRange where it can be.
  static std::optional<SliceEncoder> Create(const CloudFormat& format, Geometry geometry,
                                            RangeCoder coder = kDefaultRangeCoder);

  Geometry geometry() const { return range_encoder_ ? Geometry::kRange : Geometry::kXyz; }

  /// Takes the points out of `raw`, which holds whole points (range: whole beams) of the format,
  /// and keeps them for Encode().
  void Load(ByteView raw, std::uint32_t first_column, bool with_intensity);
  /// Of what is loaded.
  std::size_t returns() const { return returns_; }
  /// Longest range, or longest side of the points' box [m].
  double extent_m() const { return extent_m_; }
  /// Resolution of the loaded ranges [mm]: the sensor's, or 1 where they lie in between.
  std::uint32_t range_unit_mm() const { return unit_mm_; }
  bool has_intensity() const { return has_intensity_; }
  /// Names the coder that Encode() will take, for statistics and predictors: "range-adaptive".
  std::string Mode(unsigned level) const;

  /// Forgets all but `kept` of the loaded beams (range) or points (xyz).
  void Thin(const std::vector<bool>& kept);
  /// How many beams or points Thin() chooses from.
  std::size_t rows() const { return range_encoder_ ? image_.beams : cloud_.size(); }

  /// Whole scans in range geometry are cut into as many blocks, each with a thread of its own, as
  /// long as a block has kMinBlockReturns.
  void set_threads(unsigned threads) { threads_ = threads; }

  /// Encodes what is loaded, as often as wanted.
  SliceResult Encode(const SliceSettings& settings, EncodedSlice* slice);

  static constexpr RangeCoder kDefaultRangeCoder = RangeCoder::kAdaptive;
  static constexpr std::size_t kMinBlockReturns = 8'000;

 private:
  /// A sector that a thread of its own encodes.
  struct Block {
    explicit Block(const SensorModel& model) : encoder(model) {}
    RangeEncoder encoder;
    RangeImage image;
    std::vector<std::uint8_t> bytes;
  };
  SliceResult EncodeRange(const SliceSettings& settings, EncodedSlice* slice);
  bool EncodeBlocks(const RangeSettings& settings, std::uint32_t count,
                    std::vector<std::uint8_t>* out);
  SliceResult EncodeXyz(const SliceSettings& settings, EncodedSlice* slice);
  bool TryBothMethods(const XyzSettings& settings, EncodedSlice* slice, XyzResult* result);

  CloudFormat format_;
  RangeCoder coder_ = kDefaultRangeCoder;
  std::optional<RangeEncoder> range_encoder_;
  std::vector<Block> blocks_;
  RangeImage image_;
  std::uint32_t kept_beams_ = 0;  // by Thin(); 0: all
  bool has_intensity_ = false;
  FullScale full_scale_ = FullScale::kByte;
  XyzCloud cloud_;
  XyzMethod xyz_method_ = XyzMethod::kKdTree;
  unsigned xyz_slices_ = 0;  // since both methods were tried
  unsigned threads_ = 1;
  std::size_t returns_ = 0;
  double extent_m_ = 0;
  std::uint32_t unit_mm_ = 1;
};

}  // namespace lidar::codec
