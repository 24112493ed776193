// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes slices of an organised scan in range geometry: as integers, one range for each pixel.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/sensor_model.h"
#include "src/codec/azimuth_alignment.h"
#include "src/codec/block_store.h"
#include "src/codec/integer_coder.h"
#include "src/codec/mixing/mixing_codec.h"
#include "src/codec/range_header.h"
#include "src/codec/range_image.h"
#include "src/codec/rans/adaptive_coder.h"
#include "src/codec/rans/blended_coder.h"
#include "src/codec/rans/blended_mask.h"
#include "src/codec/rans/mask_coder.h"

namespace lidar::codec {

struct RangeSettings {
  RangeCoder coder = RangeCoder::kAdaptive;
  RangeGrid grid;
  IntensityScale intensity;      // with 0 bits, only geometry is coded
  std::uint32_t kept_beams = 0;  // number of beams if others were left out on purpose; 0: all beams
  unsigned effort = 1;           // effort of kMixing, 1 to 3
  bool refined = false;          // as in MixingSettings
};

/// Encodes slices of one sensor. Keeps its buffers between slices. Not thread-safe.
class RangeEncoder {
 public:
  /// `integers` codes the payloads of external coders. It may be null. It must outlive the encoder.
  explicit RangeEncoder(const SensorModel& model, const IntegerCoder* integers = nullptr)
      : alignment_(model), integers_(integers), mixing_(model) {}

  /// Appends `image` to `out` as one block. Returns false if the image does not fit the sensor, or
  /// if the coder is external and missing.
  ///
  /// Ranges must be multiples of the grid's unit. The levels of the image must have 8 bits. They
  /// are converted to those of `settings.intensity`. The image need not have any return.
  ///
  /// With a `link`, a block of kMixing becomes kTemporal if possible, so that later blocks may
  /// refer to it.
  bool Encode(const RangeImage& image, const RangeSettings& settings,
              std::vector<std::uint8_t>* out, BlockLink* link = nullptr);

 private:
  void CollectReturns(const RangeImage& image, const RangeSettings& settings);
  std::size_t returns() const { return lists_.values.size(); }
  template <class Masks, class Coder>
  void EncodeByRans(Masks* mask_coder, Coder* coder, std::uint32_t columns);
  bool EncodeIntegers(const RangeSettings& settings, std::uint32_t columns);
  std::optional<RangeCoder> EncodePayload(const RangeImage& image, const RangeSettings& settings,
                                          BlockLink* link);
  bool EncodeMixing(const RangeImage& image, const RangeSettings& settings);
  bool ChoiceSaves(const RangeImage& image, const RangeGrid& grid);
  double AdaptiveBits(const RangeImage& image, const RangeGrid& grid);
  bool EncodeLinked(const RangeImage& image, const RangeSettings& settings, BlockLink* link);
  bool EncodeOn(const RangeGrid& grid, std::uint32_t error_mm, const RangeImage& image,
                const RangeSettings& settings, BlockLink* link);

  AzimuthAlignment alignment_;
  const IntegerCoder* integers_;
  MixingEncoder mixing_;
  bool has_gaps_ = false;
  MaskCoder mask_coder_;
  AdaptiveCoder coder_;
  BlendedMask blended_mask_;
  BlendedCoder blended_;
  RansEncoder rans_;
  Mask mask_;
  IntegerLists lists_;
  std::vector<std::uint8_t> mask_bytes_;
  std::vector<std::uint8_t> payload_;
  RangeGrid grid_;  // grid of the payload
};

/// Decodes blocks of one sensor. A block may consist of any bytes: if they are not an image,
/// Decode() returns false.
class RangeDecoder {
 public:
  /// If `integers` is null, Decode() refuses blocks of external coders.
  explicit RangeDecoder(const SensorModel& model, const IntegerCoder* integers = nullptr)
      : alignment_(model), integers_(integers), mixing_(model) {}

  std::uint32_t columns_per_scan() const { return alignment_.columns_per_scan(); }

  /// Decodes the next block of `reader`. Sets `scale` to the scale of its levels. Returns false if
  /// the block is damaged, is of another sensor, or has more than `max_points` pixels. `image` is
  /// then undefined.
  ///
  /// If the block refers to another block, that block must be in `store`. If later blocks may refer
  /// to the block, it is added to `store`.
  bool Decode(ByteReader* reader, std::size_t max_points, RangeImage* image, IntensityScale* scale,
              BlockStore* store = nullptr);
  /// Returns true if the last Decode() failed because its block refers to a block that is missing.
  bool lacks_reference() const { return lacks_reference_; }
  /// Returns the header of the block decoded last.
  const RangeHeader& header() const { return header_; }
  /// Returns the largest error of the ranges in the block decoded last.
  double error_m() const;

 private:
  bool DecodeLinked(const RangeHeader& header, ByteView payload, BlockStore* store,
                    RangeImage* image, std::shared_ptr<BlockMemory>* left);
  template <class Masks, class Coder>
  bool DecodeByRans(Masks* mask_coder, Coder* coder, const RangeHeader& header, ByteView payload,
                    RangeImage* image);
  bool DecodeIntegers(const RangeHeader& header, ByteView mask, ByteView payload,
                      RangeImage* image);
  /// Writes the lists to the pixels that have returns. The values of the lists are already ranges.
  void Scatter(RangeImage* image);

  AzimuthAlignment alignment_;
  const IntegerCoder* integers_;
  MixingDecoder mixing_;
  RangeHeader header_;
  bool lacks_reference_ = false;
  MaskCoder mask_coder_;
  AdaptiveCoder coder_;
  BlendedMask blended_mask_;
  BlendedCoder blended_;
  Mask mask_;
  IntegerLists lists_;
  std::vector<std::uint8_t> padded_;  // buffer for RansDecoder
};

}  // namespace lidar::codec
