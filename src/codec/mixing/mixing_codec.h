// SPDX-License-Identifier: LGPL-2.1-or-later
// Encodes images of one sensor as payloads of the mixing coder, and decodes them
// (docs/mixing-coder.md).
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/range_grid.h"
#include "src/codec/intensity_scale.h"
#include "src/codec/mixing/slice_coder.h"
#include "src/codec/range_image.h"

namespace lidar::codec {

struct MixingSettings {
  RangeGrid grid;
  IntensityScale intensity;  // with 0 bits, only geometry is coded
  unsigned effort = 2;       // 1 to 3
  mixing::Memory memory{};   // of the image's pixels; if empty, they are coded without memory
  /// The largest error of a range. If it is above 0, the encoder chooses the cheapest bin within
  /// this error for each return. The error may exceed that of `grid`. Only effort kSearchingEffort
  /// chooses bins. With `memory`, the caller has already chosen them.
  std::uint32_t error_mm = 0;
  /// Uses refined models. These are for sensors on which the start states were not trained. Ignored
  /// at effort 1 and with `memory`.
  bool refined = false;
};

/// Returns the largest number of pixels in a payload of `payload_bytes`. A limit is needed because
/// a pixel takes a decoder 0.3 us, although a sender may need only a thousandth of a bit for it.
constexpr std::size_t MostMixedPixels(std::size_t payload_bytes) {
  constexpr std::size_t kFree = 4'096;
  constexpr std::size_t kPixelsPerByte = 256;
  return kFree + kPixelsPerByte * payload_bytes;
}

/// Reads the start states, which takes some 50 ms. Each process reads them once. Without this call,
/// they are read while the first slice waits.
void PrepareMixing();

/// Encodes images of one sensor. Keeps its buffers between slices. Not thread-safe.
class MixingEncoder {
 public:
  explicit MixingEncoder(const SensorModel& model);
  MixingEncoder(MixingEncoder&&) noexcept;
  MixingEncoder& operator=(MixingEncoder&&) noexcept;
  ~MixingEncoder();

  /// Appends the payload of `image` to `out`. Levels of 8 bits are converted to those of
  /// `settings.intensity`. Returns false and appends nothing in these cases:
  /// - The image does not have the beams and columns of the sensor.
  /// - A range is beyond the last bin (mixing::kMaxBins).
  /// - The image has more pixels than MostMixedPixels() allows for the payload.
  bool Encode(const RangeImage& image, const MixingSettings& settings,
              std::vector<std::uint8_t>* out);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Decodes payloads of one sensor. A payload may consist of any bytes: if they are not an image,
/// Decode() returns false.
class MixingDecoder {
 public:
  explicit MixingDecoder(const SensorModel& model);
  MixingDecoder(MixingDecoder&&) noexcept;
  MixingDecoder& operator=(MixingDecoder&&) noexcept;
  ~MixingDecoder();

  /// Fills ranges and intensities of `image`. The caller has set its beams, columns and
  /// first_column. `grid`, `intensity_bits` and `memory` must be those of the encoder. Returns
  /// false if the payload is damaged or of another version. The image is then undefined.
  bool Decode(ByteView payload, const RangeGrid& grid, unsigned intensity_bits, RangeImage* image,
              const mixing::Memory& memory = {});
  /// Returns the largest error [mm] of the ranges decoded last. Returns 0 if the encoder did not
  /// choose between bins. The error is then that of the grid.
  std::uint32_t error_mm() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lidar::codec
