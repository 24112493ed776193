// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes the points that CloudEncoder encodes. A slice may consist of any bytes: they give a cloud
// or an error.
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

/// Not thread-safe.
class CloudDecoder {
 public:
  explicit CloudDecoder(std::uint32_t max_points) : max_points_(max_points) {}

  /// Decodes a slice. Returns false if the stream is damaged, is of another version, or has more
  /// than max_points points. The cloud is then undefined.
  bool Decode(ByteView stream);
  /// Returns the points decoded last: first the points of beams, sorted by beam and column, then
  /// the points of cells, sorted by Morton code, then the points that are too far away for cells.
  const XyzCloud& cloud() const { return cloud_; }
  /// Returns the exact section of the stream, or null.
  ByteView exact_section() const { return exact_section_; }
  /// Returns the places of the points, if there is an exact section.
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
