// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes the points that CloudEncoder encodes; any bytes give a cloud or nothing.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/codec/cloud/beam_section.h"
#include "src/codec/cloud/cell_tree.h"
#include "src/codec/cloud/cloud_header.h"
#include "src/codec/cloud/firing_order.h"
#include "src/codec/cloud_io.h"

namespace lidar::codec::cloud {

/// For one thread at a time.
class CloudDecoder {
 public:
  explicit CloudDecoder(std::uint32_t max_points) : max_points_(max_points) {}

  /// Returns false, with the cloud undefined, for a stream that is damaged, of another version, or
  /// of more than max_points.
  bool Decode(ByteView stream);
  /// The points decoded last: those of beams by beam and column, those of cells by Morton code,
  /// then those too far away for cells.
  const XyzCloud& cloud() const { return cloud_; }
  /// The section of exact fields within the stream, or null.
  ByteView exact_section() const { return exact_section_; }
  /// The places of the points, if there is an exact section.
  const PointPlaces& places() const { return places_; }
  double step_m() const { return static_cast<double>(header_.grid.step_m); }
  double error_m() const { return header_.grid.error_m(); }
  unsigned intensity_bits() const { return header_.intensity.bits(); }

 private:
  bool DecodeCells(ByteView stream, std::size_t slice_bytes);
  bool ReadFarPoints(ByteReader* reader);

  std::uint32_t max_points_;
  CloudHeader header_;
  BeamSectionDecoder section_;
  CellTree tree_;
  CellList cells_;
  XyzCloud cloud_;
  PointPlaces places_;
  ByteView exact_section_;
};

}  // namespace lidar::codec::cloud
