// SPDX-License-Identifier: LGPL-2.1-or-later
// The header of one block of a slice in range geometry (docs/wire-format.md, "Encoded slices").
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/range_grid.h"
#include "src/codec/intensity_scale.h"

namespace lidar::codec {

/// How the integers of a block are coded. The numbers are part of the format.
enum class RangeCoder : std::uint8_t {
  kDraco = 1,     // Draco's sequential coder with its own delta prediction
  kResidual = 2,  // residuals of our prediction, by Draco's sequential coder
  kAdaptive = 3,  // residuals of our prediction, by adaptive rANS
  kMixing = 4,    // each bit by mixed contexts (docs/mixing-coder.md)
  kTemporal = 5,  // as kMixing, with memory of earlier scans
  kBlended = 6,   // as kAdaptive, with blended contexts
};

struct RangeHeader {
  RangeCoder coder = RangeCoder::kAdaptive;
  std::uint32_t beams = 0;
  std::uint32_t first_column = 0;
  std::uint32_t columns = 0;
  RangeGrid grid;
  IntensityScale intensity;        // with 0 bits, only geometry is coded
  std::uint32_t kept_beams = 0;    // number of beams if others were left out to save bits; 0: all
  bool has_gaps = false;           // some pixels have no return; a mask marks the returns
  std::uint32_t mask_size = 0;     // bytes of the mask, if it is a stream of its own
  std::uint32_t payload_size = 0;  // bytes of the payload, which follows the mask

  void Write(std::vector<std::uint8_t>* out) const;
  /// Reads a header and moves `reader` past it. Returns nothing if the version or coder is unknown,
  /// if a number is outside of its limits, or if a length is beyond the end of the bytes.
  static std::optional<RangeHeader> Read(ByteReader* reader);

  /// Returns true if the mask has a stream of its own. Our own coders code it in the payload
  /// instead.
  bool has_mask_stream() const { return has_gaps && coder < RangeCoder::kAdaptive; }

  static constexpr std::uint8_t kVersion = 3;
  static constexpr std::uint32_t kMaxBeams = 1'024;
  static constexpr std::uint32_t kMaxColumns = 16'384;
};

}  // namespace lidar::codec
