// SPDX-License-Identifier: LGPL-2.1-or-later
// Encodes clouds that have no sensor model, with points in any order.
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

/// The fields that are coded exactly, and whether the order of the points is kept.
struct ExactChoice {
  std::vector<PointField> fields;  // of the layout
  bool keeps_order = false;

  bool empty() const { return fields.empty() && !keeps_order; }
  bool operator==(const ExactChoice& o) const {
    return fields == o.fields && keeps_order == o.keeps_order;
  }
};

/// Encodes the clouds of a stream, which all have one format. Not thread-safe.
class CloudEncoder {
 public:
  /// Creates an encoder. Returns nothing if `layout` does not have x, y and z as adjacent F32
  /// fields.
  static std::optional<CloudEncoder> Create(const CloudLayout& layout, ExactChoice exact = {});

  /// Loads the points whose coordinates are finite and not all 0, for Encode().
  void Load(ByteView raw, bool with_intensity);
  /// Returns the number of loaded points.
  std::size_t returns() const { return cloud_.size(); }
  /// Returns the longest side of the box around the points [m].
  double extent_m() const;
  bool has_intensity() const { return !cloud_.intensity.empty(); }
  /// Returns the name of the coder for statistics and predictors.
  std::string Mode() const { return "xyz-cloud" + std::to_string(effort_); }
  /// Sets the effort. At effort 0, a point without a beam gets its own cell. At 1, these cells are
  /// merged. From 2 on, points share few cells. At EffortControl::kHighest, all ways are tried.
  void set_effort(unsigned effort) { effort_ = std::min(effort, EffortControl::kHighest); }
  /// Removes each loaded point whose element of `kept` is false.
  void Thin(const std::vector<bool>& kept);

  /// Encodes the loaded points. May be called several times for the same points.
  SliceResult Encode(const SliceSettings& settings, EncodedSlice* slice);
  /// Returns true if `decoded` has the exact fields and the order of the loaded points. It must
  /// have been decoded from the last slice.
  bool HasComeBack(const ExactPart& decoded) const;

 private:
  CloudEncoder(CloudLayout layout, ExactChoice exact)
      : layout_(std::move(layout)), choice_(std::move(exact)) {}
  /// A result of coding the loaded points.
  struct Candidate {
    CloudHeader header;
    std::vector<std::uint8_t> beams;         // the beam section
    std::vector<std::uint8_t> cells;         // the stream of the cells
    std::vector<std::uint8_t> exact;         // the exact section
    std::vector<std::uint32_t> cell_points;  // indices in near_, in the order of decoding
    std::vector<std::uint32_t> order;        // indices in cloud_, in the order of decoding
    std::size_t nodes = 0;
    std::size_t numbers = 0;

    std::size_t size() const { return beams.size() + cells.size() + exact.size(); }
  };
  void LoadPulses(ByteView raw, const std::vector<std::uint32_t>& rows);
  void SortOut(CloudHeader* header);
  void PutNearestLast(double nearest_m);
  float SortOutFarPoints(const CellGrid& grid);
  /// A function that chooses the cells of points.
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
  std::vector<ExactField> exact_;     // exact fields of cloud_
  std::vector<Pulse> pulses_;         // pulses of cloud_; empty: there is no line or time
  std::vector<std::uint32_t> order_;  // order of the points in the last slice
  std::vector<Point> near_;           // the points that the grid can hold
  std::vector<std::uint8_t> levels_;  // levels of near_, at full resolution; empty: geometry only
  std::vector<std::uint32_t> near_ids_;  // indices of near_ in cloud_
  std::vector<std::uint32_t> far_ids_;
  std::size_t seen_ = 0;             // number of the first points of near_ that may be in pixels
  std::vector<Sighting> sightings_;  // of the seen points
  std::vector<Pulse> sighted_;       // pulses of the seen points, or empty
  std::vector<PlacedPoint> placed_;  // of the seen points
  BeamKeeper keeper_;
  CoveredPoints covered_;
  CellTree tree_;
  PixelList pixels_;
  BeamSectionEncoder section_;
};

}  // namespace lidar::codec::cloud
