// SPDX-License-Identifier: LGPL-2.1-or-later
// Encodes clouds without a sensor model, with points in any order.
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/codec/cloud/beam_keeper.h"
#include "src/codec/cloud/beam_section.h"
#include "src/codec/cloud/cell_cover.h"
#include "src/codec/cloud/cell_tree.h"
#include "src/codec/cloud/cloud_header.h"
#include "src/codec/cloud/exact_part.h"
#include "src/codec/cloud_io.h"
#include "src/codec/effort_control.h"
#include "src/codec/slice_encoder.h"

namespace lidar::codec::cloud {

/// Fields that are coded exactly, and whether the order of points is coded, too.
struct ExactChoice {
  std::vector<PointField> fields;  // of the layout
  bool keeps_order = false;

  bool empty() const { return fields.empty() && !keeps_order; }
  bool operator==(const ExactChoice& o) const {
    return fields == o.fields && keeps_order == o.keeps_order;
  }
};

/// Encodes a stream of one format. For one thread at a time.
class CloudEncoder {
 public:
  /// Returns nothing if `layout` lacks x, y and z as adjacent F32.
  static std::optional<CloudEncoder> Create(const CloudLayout& layout, ExactChoice exact = {});

  /// Loads the points that are finite and not all zero, for Encode().
  void Load(ByteView raw, bool with_intensity);
  /// Number of loaded points.
  std::size_t returns() const { return cloud_.size(); }
  /// Longest side of the points' box [m].
  double extent_m() const;
  bool has_intensity() const { return !cloud_.intensity.empty(); }
  /// Returns the name of the coder for statistics and predictors.
  std::string Mode() const { return "xyz-cloud" + std::to_string(effort_); }
  /// Effort: at 0 a point without a beam has its own cell, at 1 such cells merge, from 2 on points
  /// share few cells, and at EffortControl::kHighest all ways are tried.
  void set_effort(unsigned effort) { effort_ = std::min(effort, EffortControl::kHighest); }
  /// Keeps the loaded points whose element of `kept` is true.
  void Thin(const std::vector<bool>& kept);

  /// Encodes the loaded points; may be called again.
  SliceResult Encode(const SliceSettings& settings, EncodedSlice* slice);
  /// Returns true if `decoded`, a decoding of the last slice, has the exact fields and the order of
  /// the loaded points.
  bool HasComeBack(const ExactPart& decoded) const;

 private:
  CloudEncoder(CloudLayout layout, ExactChoice exact)
      : layout_(std::move(layout)), choice_(std::move(exact)) {}
  /// A coding of the loaded points.
  struct Candidate {
    CloudHeader header;
    std::vector<std::uint8_t> beams;         // the section
    std::vector<std::uint8_t> cells;         // the stream
    std::vector<std::uint8_t> exact;         // the section
    std::vector<std::uint32_t> cell_points;  // indices of near_, in the order of decoding
    std::vector<std::uint32_t> order;        // indices of cloud_, likewise, for the exact section
    std::size_t nodes = 0;
    std::size_t numbers = 0;

    std::size_t size() const { return beams.size() + cells.size() + exact.size(); }
  };
  void LoadPulses(ByteView raw, const std::vector<std::uint32_t>& rows);
  void SortOut(CloudHeader* header);
  void PutNearestLast(double nearest_m);
  float SortOutFarPoints(const CellGrid& grid);
  /// Chooses the cells of points.
  using Cover = decltype(&CoverByOwnCells);
  void EncodeCells(const std::vector<std::uint32_t>& ids, Candidate* candidate);
  void CodeCells(const std::vector<Point>& points, const std::vector<std::uint32_t>& ids,
                 Cover cover, Candidate* candidate);
  bool EncodeBeams(const BeamTable& table, const PixelErrors& errors, double nearest_m,
                   const RangeWay& way, Candidate* candidate);
  bool EncodeBeamsInAllWays(const BeamTable& table, const PixelErrors& errors, Candidate* best);
  double ReachOf(const BeamTable& table) const;
  void EncodeExact(const BeamTable* table, Candidate* candidate) const;
  Candidate EncodeSmallest(const CloudHeader& header, double error_m);
  void Write(const Candidate& candidate, EncodedSlice* slice) const;
  void WriteFarPoints(const IntensityScale& scale, std::vector<std::uint8_t>* out) const;

  CloudLayout layout_;
  ExactChoice choice_;
  unsigned effort_ = 1;
  XyzCloud cloud_;
  std::vector<ExactField> exact_;        // fields of cloud_
  std::vector<Pulse> pulses_;            // of cloud_; empty: there is no line or time
  std::vector<std::uint32_t> order_;     // of the last slice
  std::vector<Point> near_;              // on the grid
  std::vector<std::uint8_t> levels_;     // of near_, at full resolution; empty: geometry only
  std::vector<std::uint32_t> near_ids_;  // of cloud_
  std::vector<std::uint32_t> far_ids_;
  std::size_t seen_ = 0;             // number of the first points of near_ that may be in pixels
  std::vector<Sighting> sightings_;  // of the seen points
  std::vector<Pulse> sighted_;       // their pulses, or none
  std::vector<PlacedPoint> placed_;  // of the seen points
  BeamKeeper keeper_;
  CoveredPoints covered_;
  CellTree tree_;
  PixelList pixels_;
  BeamSectionEncoder section_;
};

}  // namespace lidar::codec::cloud
