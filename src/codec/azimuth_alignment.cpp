// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/azimuth_alignment.h"

#include <algorithm>

namespace lidar::codec {

AzimuthAlignment::AzimuthAlignment(const SensorModel& model)
    : columns_per_scan_(model.columns_per_scan) {
  int smallest = 0;
  for (const Beam& b : model.beams)
    smallest = &b == &model.beams[0] ? b.pixel_shift : std::min(smallest, b.pixel_shift);
  for (const Beam& b : model.beams) {
    offsets_.push_back(static_cast<std::uint32_t>(b.pixel_shift - smallest));
    span_ = std::max(span_, offsets_.back());
  }
}

}  // namespace lidar::codec
