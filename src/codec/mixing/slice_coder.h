// SPDX-License-Identifier: LGPL-2.1-or-later
// A slice of bins and levels through a binary coder: the same walk encodes, decodes and trains.
#pragma once
#include <cstdint>
#include <vector>

#include "src/cloud/range_grid.h"
#include "src/codec/azimuth_alignment.h"
#include "src/codec/mixing/binary_coder.h"
#include "src/codec/mixing/model.h"
#include "src/codec/mixing/neighbours.h"

namespace lidar::codec::mixing {

/// Row-major, beam by beam. A decoder fills it.
struct SliceBins {
  std::uint32_t beams = 0;
  std::uint32_t columns = 0;
  std::int64_t step_mm = 1;          // width of a bin, roughly
  unsigned level_bits = 0;           // 0: no levels
  bool has_gaps = true;              // false: every pixel has a return
  std::vector<std::int32_t> bins;    // kNoReturn, or below kMaxBins
  std::vector<std::uint8_t> levels;  // empty without level_bits
};
constexpr std::int32_t kNoReturn = -1;

/// Keeps its buffers between slices.
class SliceCoder {
 public:
  explicit SliceCoder(const AzimuthAlignment& alignment) : alignment_(alignment) {}

  /// Codes all of `slice` at an effort from 1 on; false for a damaged stream.
  template <class Coder>
  bool Code(unsigned effort, const Kernel& kernel, Model* model, SliceBins* slice, Coder* coder);

 private:
  template <class Effort, class Coder>
  bool CodeBins(const Kernel& kernel, Model* model, SliceBins* slice, Coder* coder);
  template <class Coder>
  bool CodeLevels(const Kernel& kernel, Model* model, SliceBins* slice, Coder* coder);
  void FillNorth(const Azimuth* above, std::uint32_t columns);

  const AzimuthAlignment& alignment_;
  AlignedRow<Azimuth> above_;
  std::vector<std::int32_t> north_;
};

/// Sums up what a real coder would write.
class BitCounter {
 public:
  bool Code(bool bit, std::int32_t chance);
  double bits() const { return bits_; }

 private:
  double bits_ = 0;
};

extern template bool SliceCoder::Code(unsigned, const Kernel&, Model*, SliceBins*, BinaryEncoder*);
extern template bool SliceCoder::Code(unsigned, const Kernel&, Model*, SliceBins*, BinaryDecoder*);
extern template bool SliceCoder::Code(unsigned, const Kernel&, Model*, SliceBins*, BitCounter*);

}  // namespace lidar::codec::mixing
