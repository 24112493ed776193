// SPDX-License-Identifier: LGPL-2.1-or-later
// Range geometry: slices of an organised scan, coded as range integers.
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
  IntensityScale intensity;      // 0 bits: geometry only
  std::uint32_t kept_beams = 0;  // number of beams if others were left out on purpose; 0: all
  unsigned effort = 1;           // of kMixing, 1 to 3
  bool refined = false;          // as in MixingSettings
};

/// Encodes slices of one sensor. Keeps its buffers between slices; not for several threads at once.
class RangeEncoder {
 public:
  /// `integers` codes the payloads of external coders. It may be null, and must outlive the
  /// encoder.
  explicit RangeEncoder(const SensorModel& model, const IntegerCoder* integers = nullptr)
      : alignment_(model), integers_(integers), mixing_(model) {}

  /// Appends one block to `out`. Returns false if the image does not fit the sensor or the coder is
  /// missing. Ranges are multiples of the grid's unit. The image's levels are of 8 bits and become
  /// those of settings.intensity. An image without any return gives a block that decodes to such an
  /// image. With `link`, blocks of kMixing become kTemporal if they can, so that others may refer
  /// to them.
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
  RangeGrid grid_;  // of the payload
};

/// Decodes blocks of one sensor; any bytes give an image or false.
class RangeDecoder {
 public:
  /// If `integers` is null, blocks of external coders are refused.
  explicit RangeDecoder(const SensorModel& model, const IntegerCoder* integers = nullptr)
      : alignment_(model), integers_(integers), mixing_(model) {}

  std::uint32_t columns_per_scan() const { return alignment_.columns_per_scan(); }

  /// Decodes the next block of `reader`; `scale` gets the scale of the levels. Returns false, with
  /// `image` undefined, for a block that is damaged, of another sensor, or larger than
  /// `max_points`. Blocks that others may refer to go into `store`, and references come from there.
  bool Decode(ByteReader* reader, std::size_t max_points, RangeImage* image, IntensityScale* scale,
              BlockStore* store = nullptr);
  /// Returns true if the last Decode() failed because a block that it refers to is missing.
  bool lacks_reference() const { return lacks_reference_; }
  /// The header of the block decoded last.
  const RangeHeader& header() const { return header_; }
  /// The largest error of that block.
  double error_m() const;

 private:
  bool DecodeLinked(const RangeHeader& header, ByteView payload, BlockStore* store,
                    RangeImage* image, std::shared_ptr<BlockMemory>* left);
  template <class Masks, class Coder>
  bool DecodeByRans(Masks* mask_coder, Coder* coder, const RangeHeader& header, ByteView payload,
                    RangeImage* image);
  bool DecodeIntegers(const RangeHeader& header, ByteView mask, ByteView payload,
                      RangeImage* image);
  /// Spreads the lists, which now hold ranges, over the pixels that have returns.
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
