// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/firing_order.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace lidar::codec::cloud {
namespace {

/// The time and the column in which a beam fired.
struct Shot {
  std::int64_t clock = 0;
  std::uint32_t column = 0;
};
using Shots = std::vector<Shot>;  // sorted by clock

std::vector<Shots> ShotsOfBeams(const PointPlaces& places, const std::vector<std::int64_t>& clock) {
  std::vector<Shots> beams(places.beams);
  for (std::size_t i = 0; i < places.points.size(); ++i) {
    const PointPlace& p = places.points[i];
    if (!p.is_loose()) beams[p.beam].push_back({clock[i], p.column});
  }
  for (Shots& shots : beams)
    std::stable_sort(shots.begin(), shots.end(),
                     [](const Shot& a, const Shot& b) { return a.clock < b.clock; });
  return beams;
}

bool Descends(const Shots& shots) {
  std::size_t falls = 0;
  for (std::size_t i = 1; i < shots.size(); ++i)
    if (shots[i].column < shots[i - 1].column) ++falls;
  return 2 * falls > shots.size();
}

/// Returns the last shot that is not later than `clock`. If there is none, returns the first shot.
const Shot& LastAt(const Shots& shots, std::int64_t clock) {
  const auto after = std::upper_bound(shots.begin(), shots.end(), clock,
                                      [](std::int64_t t, const Shot& s) { return t < s.clock; });
  return after == shots.begin() ? shots.front() : *(after - 1);
}

/// Returns the most common delay of shots, and the number of shots that have it. The delay of a
/// shot is the number of columns by which it is behind the latest shot of `reference`.
std::pair<std::uint32_t, std::size_t> DelayOf(const Shots& shots, const Shots& reference,
                                              std::uint32_t columns) {
  std::map<std::uint32_t, std::size_t> votes;
  for (const Shot& shot : shots)
    ++votes[(LastAt(reference, shot.clock).column + columns - shot.column) % columns];
  const auto most = std::max_element(
      votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == votes.end()) return {};
  return *most;
}

/// Sets the rank of each beam in a firing. The beams are sorted by the mean time that passes from
/// the shot of `reference` to their own shot in the same firing.
void RankBeams(const std::vector<Shots>& beams, const Shots& reference, std::uint32_t columns,
               FiringOrder* order) {
  std::vector<std::int64_t> clock_of(columns, INT64_MIN);
  for (const Shot& shot : reference) clock_of[shot.column] = shot.clock;
  std::vector<double> after(beams.size(), 0);
  for (std::size_t b = 0; b < beams.size(); ++b) {
    std::size_t count = 0;
    for (const Shot& shot : beams[b]) {
      const std::int64_t at = clock_of[(shot.column + order->slots[b].delay) % columns];
      if (at == INT64_MIN) continue;
      after[b] += static_cast<double>(shot.clock) - static_cast<double>(at);
      ++count;
    }
    if (count > 0) after[b] /= static_cast<double>(count);
  }
  std::vector<std::uint32_t> sorted(beams.size());
  std::iota(sorted.begin(), sorted.end(), 0U);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return after[a] < after[b]; });
  for (std::uint32_t i = 0; i < sorted.size(); ++i) order->slots[sorted[i]].rank = i;
}

}  // namespace

std::vector<std::uint32_t> FiringOrder::Visit(const PointPlaces& places) const {
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> visit;
  visit.reserve(places.points.size());
  constexpr unsigned kPlaceBits = 28;
  constexpr unsigned kRankBits = 10;
  for (std::size_t i = 0; i < places.points.size(); ++i) {
    const PointPlace& place = places.points[i];
    if (place.is_loose()) continue;
    const std::uint64_t firing = FiringOf(place, places.columns);
    keys.push_back((firing << kRankBits | slots[place.beam].rank) << kPlaceBits | i);
  }
  std::sort(keys.begin(), keys.end());
  for (const std::uint64_t key : keys)
    visit.push_back(static_cast<std::uint32_t>(key & ((1U << kPlaceBits) - 1)));
  for (std::size_t i = 0; i < places.points.size(); ++i)
    if (places.points[i].is_loose()) visit.push_back(static_cast<std::uint32_t>(i));
  return visit;
}

FiringOrder FindFiringOrder(const PointPlaces& places, const std::vector<std::int64_t>& clock,
                            double* fit) {
  FiringOrder order;
  order.slots.resize(places.beams);
  for (std::uint32_t b = 0; b < places.beams; ++b) order.slots[b].rank = b;
  *fit = 0;
  const auto beams = ShotsOfBeams(places, clock);
  const auto most =
      std::max_element(beams.begin(), beams.end(),
                       [](const Shots& a, const Shots& b) { return a.size() < b.size(); });
  if (most == beams.end() || most->empty()) return order;
  const Shots& reference = *most;
  order.descends = Descends(reference);
  std::size_t fitting = 0;
  std::size_t all = 0;
  for (std::size_t b = 0; b < beams.size(); ++b) {
    const auto [delay, votes] = DelayOf(beams[b], reference, places.columns);
    order.slots[b].delay = delay;
    fitting += votes;
    all += beams[b].size();
  }
  *fit = static_cast<double>(fitting) / static_cast<double>(all);
  RankBeams(beams, reference, places.columns, &order);
  order.first = reference.front().column;
  return order;
}

}  // namespace lidar::codec::cloud
