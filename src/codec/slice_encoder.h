// SPDX-License-Identifier: LGPL-2.1-or-later
// Encodes the raw slices of one stream in range geometry.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/codec/cloud_io.h"
#include "src/codec/range_codec.h"
#include "src/codec/reference_keeper.h"
#include "src/codec/standstill.h"

namespace lidar::codec {

struct SliceSettings {
  double max_error_m = 0.02;  // largest 3D error of any point
  double step_m = 0;          // step of the grid; 0: the coarsest that max_error_m allows
  unsigned intensity_bits = 0;
};

struct EncodedSlice {
  std::vector<std::uint8_t> bytes;
  std::size_t returns = 0;
  double step_m = 0;
  double error_m = 0;                  // largest error with this step
  std::vector<BlockMemoryPtr> blocks;  // memories for later slices; may be empty
};

enum class SliceResult {
  kEncoded,
  kEmpty,       // no points to encode, or too many
  kOutOfReach,  // no grid meets max_error_m
};

/// Encodes the slices of a stream, which all have one format. Not thread-safe.
class SliceEncoder {
 public:
  /// Creates an encoder. Returns nothing if `format` has no ranges. `integers` is needed for
  /// external coders, and must outlive the encoder.
  static std::optional<SliceEncoder> Create(const CloudFormat& format,
                                            RangeCoder coder = RangeCoder::kAdaptive,
                                            const IntegerCoder* integers = nullptr);

  /// Loads the ranges of `raw` for Encode(), and its intensities if `with_intensity`. `raw` has all
  /// beams of the format.
  void Load(ByteView raw, std::uint32_t first_column, bool with_intensity);
  /// Returns the number of returns that are loaded.
  std::size_t returns() const { return returns_; }
  /// Returns the longest range that is loaded [m].
  double extent_m() const { return extent_m_; }
  /// Returns the unit of the loaded ranges [mm], as CommonUnit() finds it.
  std::uint32_t range_unit_mm() const { return unit_mm_; }
  bool has_intensity() const { return has_intensity_; }
  /// Returns the name of the coder for statistics and predictors, such as "range-adaptive",
  /// "range-mixing2" or "range-temporal2".
  std::string Mode() const;
  /// Lets the loaded slice refer to slices that the receiver has, if the effort is above 0 and if
  /// that saves bits. `keeper` must have begun this slice, and must outlive its coding. If `keeper`
  /// is null, the slice has no references.
  void LinkBy(const ReferenceKeeper* keeper);
  /// Sets the effort of our own coder. Effort 0 is RangeCoder::kAdaptive. Efforts from 1 to
  /// EffortControl::kHighest are kMixing: a higher effort takes more time and gives smaller slices.
  void set_effort(unsigned effort);

  /// Removes the returns of each loaded beam whose element of `kept` is false.
  void Thin(const std::vector<bool>& kept);
  /// Returns the number of beams from which Thin() chooses.
  std::size_t rows() const { return image_.beams; }

  /// Sets the largest number of blocks in a slice. Each block is encoded by its own thread. There
  /// are fewer blocks if they would have less than kMinBlockReturns returns on average.
  void set_threads(unsigned threads) { threads_ = threads; }

  /// Encodes the loaded slice. May be called several times for the same slice.
  SliceResult Encode(const SliceSettings& settings, EncodedSlice* slice);

  static constexpr std::size_t kMinBlockReturns = 8'000;

 private:
  /// A block of the slice. A thread of its own encodes it.
  struct Block {
    Block(const SensorModel& model, const IntegerCoder* integers) : encoder(model, integers) {}
    RangeEncoder encoder;
    RangeImage image;
    std::vector<std::uint8_t> bytes;
    BlockLink link;
    bool encoded = false;
  };
  SliceEncoder(const CloudFormat& format, RangeCoder coder, const IntegerCoder* integers);
  RangeGrid GridFor(const SliceSettings& settings) const;
  bool EncodeBlock(const RangeImage& image, const RangeSettings& settings, RangeEncoder* encoder,
                   BlockLink* link, std::vector<std::uint8_t>* out) const;
  bool EncodeBlocks(const RangeSettings& settings, std::uint32_t count, EncodedSlice* slice);

  CloudFormat format_;
  RangeCoder coder_;
  unsigned effort_ = 0;
  const IntegerCoder* integers_;
  std::vector<Block> blocks_;
  RangeImage image_;
  std::uint32_t kept_beams_ = 0;  // number of beams that Thin() kept; 0: all
  bool has_intensity_ = false;
  FullScale full_scale_ = FullScale::kByte;
  unsigned threads_ = 1;
  std::size_t returns_ = 0;
  double extent_m_ = 0;
  std::uint32_t unit_mm_ = 1;

  Standstill standstill_;
  const ReferenceKeeper* keeper_ = nullptr;  // has begun the loaded slice; null: no references
  bool refers_ = false;                      // the loaded slice may refer to others
  double last_step_m_ = 0.04;
};

}  // namespace lidar::codec
