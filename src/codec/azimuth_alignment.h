// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the pixels of neighbouring beams that have the same azimuth.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/cloud/sensor_model.h"

namespace lidar::codec {

/// The beams of a spinning sensor fire at the same time, but at different azimuths. Therefore the
/// pixels of a column have different azimuths. Coders process a slice beam by beam, and keep a
/// value from the beams above for each azimuth. The neighbours above pixel i of beam b are
/// AlignedRow::At(b)[i - 1 .. i + 1].
class AzimuthAlignment {
 public:
  AzimuthAlignment() = default;
  explicit AzimuthAlignment(const SensorModel& model);

  std::uint32_t columns_per_scan() const { return columns_per_scan_; }
  std::uint32_t beams() const { return static_cast<std::uint32_t>(offsets_.size()); }
  std::uint32_t offset(std::uint32_t beam) const { return offsets_[beam]; }
  std::uint32_t span() const { return span_; }

 private:
  std::vector<std::uint32_t> offsets_;  // pixel shifts of the beams, minus the smallest shift
  std::uint32_t span_ = 0;
  std::uint32_t columns_per_scan_ = 0;
};

/// The newest value at each azimuth of a slice.
template <class T>
class AlignedRow {
 public:
  /// Sets each value to `initial`.
  void Reset(const AzimuthAlignment& alignment, std::uint32_t columns, T initial) {
    alignment_ = &alignment;
    columns_ = columns;
    size_ = std::size_t{columns} + alignment.span() + 2 * kMargin;
    closed_ = columns == alignment.columns_per_scan() && alignment.span() + 2 * kMargin <= columns;
    values_.assign(size_, initial);
  }
  /// Returns a pointer to the value at pixel 0 of `beam`. Indices in [-kMargin .. columns +
  /// kMargin) are valid.
  T* At(std::uint32_t beam) { return &values_[kMargin + alignment_->offset(beam)]; }
  /// Must be called after At(beam)[0 .. columns) was written. In a full turn, the last and the
  /// first column are neighbours, so each of them is copied to the margin beside the other.
  void CloseTurn(std::uint32_t beam) {
    if (!closed_) return;
    const std::size_t begin = kMargin + alignment_->offset(beam);
    for (std::size_t i = begin; i-- > 0;) values_[i] = values_[i + columns_];
    for (std::size_t i = begin + columns_; i < size_; ++i) values_[i] = values_[i - columns_];
  }

  static constexpr std::size_t kMargin = 8;

 private:
  const AzimuthAlignment* alignment_ = nullptr;
  std::vector<T> values_;
  std::size_t size_ = 0;
  std::uint32_t columns_ = 0;
  bool closed_ = false;
};

}  // namespace lidar::codec
