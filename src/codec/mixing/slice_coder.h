// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes a slice of bins and levels with a binary coder. The same code encodes and decodes.
#pragma once
#include <cstdint>
#include <vector>

#include "src/cloud/range_grid.h"
#include "src/codec/azimuth_alignment.h"
#include "src/codec/mixing/binary_coder.h"
#include "src/codec/mixing/model.h"
#include "src/codec/mixing/neighbours.h"

namespace lidar::codec {
struct PixelMemory;
}

namespace lidar::codec::mixing {

struct TemporalModel;

/// How the newest pixel at an azimuth differs from what its memory predicted.
struct Surprise {
  std::uint8_t shift = 3;  // 0 to 6: the bin differs by -3 to 3; kChanged: by more
  bool returns = false;    // true: only one of the last scan and this one has a return

  static constexpr std::uint8_t kChanged = 7;
};

/// The bins and levels of a slice, in row-major order. A row is a beam. A decoder fills `bins` and
/// `levels`.
struct SliceBins {
  std::uint32_t beams = 0;
  std::uint32_t columns = 0;
  std::int64_t step_mm = 1;          // width of a bin, roughly
  unsigned level_bits = 0;           // 0: no levels
  bool has_gaps = true;              // false: every pixel has a return
  bool refined = false;              // uses refined models; ignored at effort 1
  std::vector<std::int32_t> bins;    // kNoReturn, or below kMaxBins
  std::vector<std::uint8_t> levels;  // empty if level_bits is 0
  /// For each return, the number of further bins, above the one in `bins`, that the return may
  /// have. At effort kSearchingEffort an encoder chooses the cheapest of these bins. If `spare` is
  /// empty, there is no choice.
  std::vector<std::uint8_t> spare;
};
constexpr std::int32_t kNoReturn = -1;

/// The memory of a slice's pixels, and the model that predicts the slice from this memory.
struct Memory {
  const PixelMemory* pixels = nullptr;  // of all pixels of the slice, or null
  TemporalModel* model = nullptr;       // learns from the slice
};
struct Recollection {
  Memory memory;
  RangeGrid grid;  // of the slice
};

/// A step of a bin search: the bin that was chosen, and the step before it.
struct SearchStep {
  std::int32_t bin;
  std::uint32_t before;  // index of the previous step + 1; 0: none
};

/// The lowest effort at which an encoder can choose between bins.
constexpr unsigned kSearchingEffort = 3;

/// Codes slices. Keeps its buffers between slices.
class SliceCoder {
 public:
  explicit SliceCoder(const AzimuthAlignment& alignment) : alignment_(alignment) {}

  /// Codes all of `slice`. `effort` is from 1 to 3. Returns false if the stream is damaged.
  template <class Coder>
  bool Code(unsigned effort, Model* model, SliceBins* slice, Coder* coder,
            const Recollection* recollection = nullptr);

 private:
  template <class Effort, class Coder>
  bool CodeBins(Model* model, SliceBins* slice, Coder* coder);
  template <class Effort, class Coder>
  bool CodeRecalledBins(Model* model, SliceBins* slice, Coder* coder,
                        const Recollection& recollection);
  template <class Effort, class Coder>
  bool CodeAll(Model* model, SliceBins* slice, Coder* coder, const Recollection* recollection);
  template <class Effort, class Coder>
  bool CodeLevels(Model* model, SliceBins* slice, Coder* coder);
  void FillNorth(const Azimuth* above, std::uint32_t columns);

  const AzimuthAlignment& alignment_;
  AlignedRow<Azimuth> above_;
  AlignedRow<Surprise> surprises_;
  std::vector<std::int32_t> north_;
  std::vector<SearchStep> search_steps_;
};

extern template bool SliceCoder::Code(unsigned, Model*, SliceBins*, BinaryEncoder*,
                                      const Recollection*);
extern template bool SliceCoder::Code(unsigned, Model*, SliceBins*, BinaryDecoder*,
                                      const Recollection*);

}  // namespace lidar::codec::mixing
