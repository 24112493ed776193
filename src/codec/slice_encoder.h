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
  double max_error_m = 0.02;  // bound of the 3D error of every point
  double step_m = 0;          // of the grid; 0: the coarsest that max_error_m allows
  unsigned intensity_bits = 0;
};

struct EncodedSlice {
  std::vector<std::uint8_t> bytes;
  std::size_t returns = 0;
  double step_m = 0;
  double error_m = 0;                  // bound with this step
  std::vector<BlockMemoryPtr> blocks;  // memories for later slices; may be empty
};

enum class SliceResult {
  kEncoded,
  kEmpty,       // no return to encode
  kOutOfReach,  // no grid meets max_error_m
};

/// Encodes a stream of one format. For one thread at a time.
class SliceEncoder {
 public:
  /// Returns nothing if `format` has no ranges. `integers` is needed for external coders, and must
  /// outlive the encoder.
  static std::optional<SliceEncoder> Create(const CloudFormat& format,
                                            RangeCoder coder = RangeCoder::kAdaptive,
                                            const IntegerCoder* integers = nullptr);

  /// Loads the ranges of `raw`, which holds whole beams of the format, for Encode().
  void Load(ByteView raw, std::uint32_t first_column, bool with_intensity);
  /// Number of returns that are loaded.
  std::size_t returns() const { return returns_; }
  /// Longest range [m].
  double extent_m() const { return extent_m_; }
  /// Resolution of the loaded ranges [mm]: their CommonUnit().
  std::uint32_t range_unit_mm() const { return unit_mm_; }
  bool has_intensity() const { return has_intensity_; }
  /// Returns the name of the coder for statistics and predictors: "range-adaptive",
  /// "range-mixing2", "range-temporal2".
  std::string Mode() const;
  /// Lets the loaded slice refer to those that the receiver has, if that saves bits and the effort
  /// is above 0. `keeper` has begun this slice, and must outlive its coding. Null: slices stand
  /// alone.
  void LinkBy(const ReferenceKeeper* keeper);
  /// Effort of our own coder: 0 is RangeCoder::kAdaptive, 1 to EffortControl::kHighest are kMixing,
  /// each slower than the one below, with smaller slices.
  void set_effort(unsigned effort);

  /// Keeps the loaded beams whose element of `kept` is true.
  void Thin(const std::vector<bool>& kept);
  /// Number of beams that Thin() chooses from.
  std::size_t rows() const { return image_.beams; }

  /// Most blocks of a slice. Each has a thread of its own, and at least kMinBlockReturns returns.
  void set_threads(unsigned threads) { threads_ = threads; }

  /// Encodes the loaded slice; may be called again.
  SliceResult Encode(const SliceSettings& settings, EncodedSlice* slice);

  static constexpr std::size_t kMinBlockReturns = 8'000;

 private:
  /// A sector that a thread of its own encodes.
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
  std::uint32_t kept_beams_ = 0;  // by Thin(); 0: all
  bool has_intensity_ = false;
  FullScale full_scale_ = FullScale::kByte;
  unsigned threads_ = 1;
  std::size_t returns_ = 0;
  double extent_m_ = 0;
  std::uint32_t unit_mm_ = 1;

  Standstill standstill_;
  const ReferenceKeeper* keeper_ = nullptr;  // of the loaded slice; null: it stands alone
  bool refers_ = false;                      // the loaded slice may refer to others
  double last_step_m_ = 0.04;
};

}  // namespace lidar::codec
