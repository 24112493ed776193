// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/demand_table.h"

#include <algorithm>
#include <limits>

namespace lidar::rate {

Demand& Demand::operator+=(const Demand& o) {
  coarsest += o.coarsest;
  finest += o.finest;
  for (std::size_t i = 0; i < intensity.size(); ++i) intensity[i] += o.intensity[i];
  return *this;
}

Demand& Demand::operator*=(double factor) {
  coarsest *= factor;
  finest *= factor;
  for (double& bytes : intensity) bytes *= factor;
  return *this;
}

void DemandTable::Set(std::uint32_t slice_index, std::uint32_t slice_count, const Demand& demand) {
  if (slices_.size() != slice_count) {
    slices_.assign(slice_count, std::nullopt);
    seen_ = 0;
  }
  if (slice_index >= slice_count) return;
  if (!slices_[slice_index]) ++seen_;
  slices_[slice_index] = demand;
}

Demand DemandTable::Sum(std::uint32_t first) const {
  Demand all;
  Demand sum;
  std::size_t unseen = 0;
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    if (slices_[i]) all += *slices_[i];
    if (i < first) continue;
    if (slices_[i])
      sum += *slices_[i];
    else
      ++unseen;
  }
  if (unseen > 0 && seen_ > 0) {
    all *= static_cast<double>(unseen) / static_cast<double>(seen_);
    sum += all;
  }
  return sum;
}

double DemandTable::EvenShare(std::uint32_t first, double surplus) const {
  std::vector<double> rooms;
  for (std::size_t i = first; i < slices_.size(); ++i) {
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    rooms.push_back(slices_[i] ? slices_[i]->finest - slices_[i]->coarsest : kUnknown);
  }
  std::sort(rooms.begin(), rooms.end());
  for (auto room = rooms.begin(); room != rooms.end(); ++room) {
    const double share = surplus / static_cast<double>(rooms.end() - room);
    if (*room >= share) return share;
    surplus -= *room;
  }
  // The surplus exceeds what all slices can use.
  return rooms.empty() ? surplus : rooms.back() + surplus / static_cast<double>(rooms.size());
}

}  // namespace lidar::rate
