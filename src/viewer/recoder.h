// SPDX-License-Identifier: LGPL-2.1-or-later
// Encodes decoded slices again, so that each can be decoded without other slices.
#pragma once
#include <optional>
#include <vector>

#include "src/codec/slice_decoder.h"
#include "src/codec/slice_encoder.h"

namespace lidar::viewer {

/// Encodes slices without references. On the same grid, such slices need more bits than the robot's
/// slices. The grid is therefore made coarser until both streams have about the same size. Only one
/// thread at a time may use it.
class Recoder {
 public:
  /// Makes a recoder. Returns nothing if `format` has no ranges.
  static std::optional<Recoder> Create(const codec::CloudFormat& format);

  /// A decoded slice: its points in memory, and their properties.
  struct Decoded {
    ByteView points;
    codec::SliceDecoder::Shape shape;
    codec::SliceDecoder::Quality quality;
    std::size_t coded_size = 0;  // bytes
  };
  /// Encodes a slice. Returns false if that is impossible.
  bool Encode(const Decoded& slice, std::vector<std::uint8_t>* out);
  /// Returns the step of the grid divided by the step of the robot's grid.
  double coarseness() const { return coarseness_; }

 private:
  Recoder(codec::SliceEncoder encoder) : encoder_(std::move(encoder)) {}
  void Adapt(std::size_t coded, std::size_t recoded);

  codec::SliceEncoder encoder_;
  double coarseness_ = 1;
  double coded_ = 0;  // bytes per slice, averaged over about a scan
  double recoded_ = 0;
};

}  // namespace lidar::viewer
