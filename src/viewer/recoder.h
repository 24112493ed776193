// SPDX-License-Identifier: LGPL-2.1-or-later
// Re-codes decoded slices so that each stands alone.
#pragma once
#include <optional>
#include <vector>

#include "src/codec/slice_decoder.h"
#include "src/codec/slice_encoder.h"

namespace lidar::viewer {

/// A slice without references needs more bits on the same grid. So the grid becomes coarser until
/// the stream has about the robot's size. For one thread at a time.
class Recoder {
 public:
  /// Returns nothing if `format` has no ranges.
  static std::optional<Recoder> Create(const codec::CloudFormat& format);

  /// A decoder's output: points as they lie in memory, and their properties.
  struct Decoded {
    ByteView points;
    codec::SliceDecoder::Shape shape;
    codec::SliceDecoder::Quality quality;
    std::size_t coded_size = 0;  // bytes
  };
  /// Returns false if the slice cannot be coded.
  bool Encode(const Decoded& slice, std::vector<std::uint8_t>* out);
  /// Grid step relative to the robot's grid.
  double coarseness() const { return coarseness_; }

 private:
  Recoder(codec::SliceEncoder encoder) : encoder_(std::move(encoder)) {}
  void Adapt(std::size_t coded, std::size_t recoded);

  codec::SliceEncoder encoder_;
  double coarseness_ = 1;
  double coded_ = 0;  // bytes, averaged over about a scan
  double recoded_ = 0;
};

}  // namespace lidar::viewer
