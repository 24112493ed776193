// SPDX-License-Identifier: LGPL-2.1-or-later
// Payloads of the mixing coder: images of one sensor to bytes and back (docs/mixing-coder.md).
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
  IntensityScale intensity;  // 0 bits: geometry only
  unsigned effort = 2;       // 1 to 3
  mixing::Memory memory{};   // of the image's pixels; empty: the image stands alone
  /// If above 0, at effort kSearchingEffort, each return takes the cheapest bin within this error,
  /// which may exceed that of `grid`. With `memory`, the caller has chosen the bins.
  std::uint32_t error_mm = 0;
  /// Uses refined models, for sensors on which the start states were not trained. Ignored at effort
  /// 1 and with a memory.
  bool refined = false;
};

/// Most pixels that a payload of `payload_bytes` may have. A pixel costs a decoder 0.3 us, but its
/// sender perhaps a thousandth of a bit.
constexpr std::size_t MostMixedPixels(std::size_t payload_bytes) {
  constexpr std::size_t kFree = 4'096;
  constexpr std::size_t kPixelsPerByte = 256;
  return kFree + kPixelsPerByte * payload_bytes;
}

/// Reads the start states, once a process, in some 50 ms. Without a call the first slice waits for
/// that.
void PrepareMixing();

/// Keeps its buffers between slices; not for several threads at once.
class MixingEncoder {
 public:
  explicit MixingEncoder(const SensorModel& model);
  MixingEncoder(MixingEncoder&&) noexcept;
  MixingEncoder& operator=(MixingEncoder&&) noexcept;
  ~MixingEncoder();

  /// Appends a payload to `out`. Ranges are multiples of the grid's unit; levels of 8 bits become
  /// those of settings.intensity. Returns false, with nothing appended, if the image does not fit
  /// the sensor, has ranges past mixing::kMaxBins bins, or has more pixels than MostMixedPixels()
  /// allows for the payload.
  bool Encode(const RangeImage& image, const MixingSettings& settings,
              std::vector<std::uint8_t>* out);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Decodes payloads of one sensor; any bytes give an image or false.
class MixingDecoder {
 public:
  explicit MixingDecoder(const SensorModel& model);
  MixingDecoder(MixingDecoder&&) noexcept;
  MixingDecoder& operator=(MixingDecoder&&) noexcept;
  ~MixingDecoder();

  /// Fills ranges and levels of `image`, whose beams, columns and first_column are set. The grid,
  /// the bits of the intensity and the memory are those of the encoder. Returns false, with the
  /// image undefined, for a payload that is damaged or of another version.
  bool Decode(ByteView payload, const RangeGrid& grid, unsigned intensity_bits, RangeImage* image,
              const mixing::Memory& memory = {});
  /// Largest error of the image decoded last, if its encoder chose between bins; 0: the grid's.
  std::uint32_t error_mm() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lidar::codec
