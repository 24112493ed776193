// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/viewer/feed.h"

#include <algorithm>

namespace lidar::viewer {
namespace {

constexpr std::size_t kRecentScans = 2;
/// The largest number of slices in a scan. A hostile sender could send any number of slices.
constexpr std::size_t kMostSlices = 1024;
/// The largest number of unacknowledged recorded slices. A hostile file could contain slices of one
/// byte each.
constexpr std::size_t kMostRecorded = 512;
/// The number of blocks that a viewer is assumed to have. A decoder keeps 24 blocks for each
/// sector, and a scan of our streams has at most 128 sectors.
constexpr std::size_t kMostKnown = 4096;

}  // namespace

void RecentScans::Add(SharedSlice slice) {
  const auto is_of = [number = slice->id.scan](const Scan& s) { return s.number == number; };
  auto scan = std::find_if(scans_.begin(), scans_.end(), is_of);
  if (scan == scans_.end()) {
    if (slice->is_recoded) return;  // its scan is no longer kept
    if (scans_.size() == kRecentScans) scans_.pop_front();
    scans_.push_back({slice->id.scan, {}});
    scan = std::prev(scans_.end());
  }
  if (scan->slices.size() >= kMostSlices && scan->slices.count(slice->id.index) == 0) return;
  Forms& forms = scan->slices[slice->id.index];
  (slice->is_recoded ? forms.recoded : forms.own) = std::move(slice);
}

std::vector<SharedSlice> WithReferences(const std::vector<SharedSlice>& slices, std::size_t first) {
  std::vector<SharedSlice> out;
  std::unordered_set<std::uint32_t> needed;
  for (std::size_t i = slices.size(); i-- > 0;) {
    const auto& blocks = slices[i]->blocks;
    const bool wanted = i >= first || std::any_of(blocks.begin(), blocks.end(), [&](const auto& b) {
                          return needed.count(b.crc) > 0;
                        });
    if (!wanted) continue;
    for (const codec::BlockName& block : blocks)
      if (block.reference) needed.insert(*block.reference);
    out.push_back(slices[i]);
  }
  std::reverse(out.begin(), out.end());
  return out;
}

std::vector<SharedSlice> Feed::Take(Time now, const RecentScans& recent) {
  Begin(now, recent);
  std::vector<SharedSlice> out;
  for (const RecentScans::Scan& scan : recent.scans()) {
    const auto taken = std::find_if(taken_.begin(), taken_.end(),
                                    [&](const Taken& t) { return t.scan == scan.number; });
    if (taken == taken_.end()) continue;
    for (const auto& [index, forms] : scan.slices) {
      if (taken->sent.count(index) > 0) continue;
      const bool own = forms.own && Knows(*forms.own);
      if (forms.own) wants_recoded_ = !own;
      const SharedSlice& slice = own ? forms.own : forms.recoded;
      if (!slice) continue;
      if (own) Learn(*slice);
      taken->sent.insert(index);
      pace_.OnSent(now, slice->id, slice->size);
      out.push_back(slice);
    }
  }
  return out;
}

std::vector<SharedSlice> Feed::TakeRecorded(Time now, std::deque<SharedSlice>* waiting) {
  std::vector<SharedSlice> out;
  while (!waiting->empty() && pace_.unacknowledged_slices() < kMostRecorded &&
         pace_.MayBegin(now)) {
    const SharedSlice& next = waiting->front();
    pace_.OnSent(now, next->id, next->size);
    out.push_back(next);
    waiting->pop_front();
  }
  return out;
}

/// Begins the newest scan if the pace allows it.
void Feed::Begin(Time now, const RecentScans& recent) {
  if (recent.scans().empty()) return;
  const std::uint32_t newest = recent.scans().back().number;
  if (newest_ != newest) {
    if (skipping_) ++scans_skipped_;
    newest_ = newest;
    skipping_ = true;
  }
  if (!skipping_ || !pace_.MayBegin(now)) return;
  skipping_ = false;
  taken_.push_back({newest, {}});
  if (taken_.size() > kRecentScans) taken_.pop_front();
}

void Feed::OnLacksReference() {
  known_.clear();
  order_.clear();
}

bool Feed::Knows(const Slice& slice) const {
  return std::all_of(slice.blocks.begin(), slice.blocks.end(), [this](const auto& block) {
    return !block.reference || known_.count(*block.reference) > 0;
  });
}

void Feed::Learn(const Slice& slice) {
  for (const codec::BlockName& block : slice.blocks) {
    if (!known_.insert(block.crc).second) continue;
    order_.push_back(block.crc);
    if (order_.size() <= kMostKnown) continue;
    known_.erase(order_.front());
    order_.pop_front();
  }
}

}  // namespace lidar::viewer
