// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/slice_ledger.h"

#include <algorithm>
#include <utility>

#include "src/base/sequence.h"

namespace lidar::rtp {
namespace {

// The limit bounds memory and time. The reassembler has a smaller limit already (kMaxScanJump).
constexpr std::int64_t kMaxOpenScans = 64;
// A slice may list 64 skipped slices, which may belong to as many scans.
constexpr std::int64_t kKeptScans = 64;
constexpr int kToldSlices = 64;

}  // namespace

SliceAccounts& SliceAccounts::operator+=(const SliceAccounts& o) {
  slices_received += o.slices_received;
  slices_lost += o.slices_lost;
  slices_damaged += o.slices_damaged;
  slices_config_mismatch += o.slices_config_mismatch;
  slices_skipped += o.slices_skipped;
  scans_complete += o.scans_complete;
  scans_incomplete += o.scans_incomplete;
  scans_lost += o.scans_lost;
  scans_skipped += o.scans_skipped;
  return *this;
}

Admission SliceLedger::Admit(SlicePosition p, std::uint32_t count, Time now) {
  if (!started()) {
    Start(p, count);
    return Admission::kOpen;
  }
  if (p < origin_ || p.scan < open_scan_) return Admission::kTooOld;
  if (p.scan - frontier_->scan > kMaxOpenScans) return Admission::kContradiction;
  if (Contradicts(p.scan, count)) return Admission::kContradiction;
  if (*frontier_ < p) {
    AppendScans(p.scan, count);
    frontier_ = p;
    cutoffs_.push_back({now + max_reorder_time_, p});
    while (p.scan - open_scan_ >= kMaxOpenScans) CloseBefore({open_scan_ + 1, 0});
  }
  Scan* scan = Find(p.scan);
  if (scan == nullptr) return Admission::kTooOld;
  if (scan->slices.size() != count) {
    scan->slices.assign(count, SliceOutcome::kOpen);
    scan->open = count;
  }
  scan->count_known = true;
  switch (scan->slices[p.index]) {
    case SliceOutcome::kOpen:
      return Admission::kOpen;
    case SliceOutcome::kLost:
      return Admission::kTooOld;
    default:
      return Admission::kSettled;
  }
}

bool SliceLedger::Contradicts(std::int64_t number, std::uint32_t count) {
  const Scan* scan = Find(number);
  if (scan == nullptr || scan->slices.size() == count) return false;
  // A number of slices that was guessed may change until the first slice of the scan is counted.
  return scan->count_known || scan->open != scan->slices.size();
}

void SliceLedger::Start(SlicePosition p, std::uint32_t count) {
  origin_ = p;
  frontier_ = p;
  origin_count_ = count;
  first_scan_ = open_scan_ = p.scan;
  scans_.clear();
  AppendScans(p.scan, count);
  Scan& scan = scans_.front();
  scan.count_known = true;
  scan.joined_late = p.index > 0;
  // Slices before the first received slice are not counted.
  std::fill_n(scan.slices.begin(), p.index, SliceOutcome::kLost);
  scan.open = count - p.index;
}

void SliceLedger::AppendScans(std::int64_t up_to, std::uint32_t count) {
  while (first_scan_ + static_cast<std::int64_t>(scans_.size()) <= up_to) {
    Scan scan;
    scan.slices.assign(count, SliceOutcome::kOpen);
    scan.open = count;
    scans_.push_back(std::move(scan));
  }
}

void SliceLedger::Settle(SlicePosition p, SliceOutcome outcome) {
  Scan* scan = Find(p.scan);
  if (scan != nullptr) Close(scan, p.index, outcome);
}

void SliceLedger::Close(Scan* scan, std::uint32_t index, SliceOutcome outcome) {
  if (index >= scan->slices.size() || scan->slices[index] != SliceOutcome::kOpen) return;
  scan->slices[index] = outcome;
  --scan->open;
  switch (outcome) {
    case SliceOutcome::kReceived:
      ++accounts_.slices_received;
      ++scan->received;
      break;
    case SliceOutcome::kDamaged:
      ++accounts_.slices_damaged;
      break;
    case SliceOutcome::kConfigMismatch:
      ++accounts_.slices_config_mismatch;
      break;
    case SliceOutcome::kSkipped:
      ++accounts_.slices_skipped;
      ++scan->skipped;
      break;
    default:
      ++accounts_.slices_lost;
      break;
  }
  if (scan->open == 0) BookScan(scan);
}

void SliceLedger::BookScan(Scan* scan) {
  if (scan->joined_late) return;
  if (scan->skipped == scan->slices.size()) {
    scan->booked = &SliceAccounts::scans_skipped;
  } else if (scan->received == 0) {
    scan->booked = &SliceAccounts::scans_lost;
  } else if (scan->received + scan->skipped == scan->slices.size()) {
    scan->booked = &SliceAccounts::scans_complete;
  } else {
    scan->booked = &SliceAccounts::scans_incomplete;
  }
  ++(accounts_.*(scan->booked));
}

void SliceLedger::Skip(SlicePosition p) {
  if (p < origin_) {
    SkipBeforeOrigin(p);
    return;
  }
  Scan* scan = Find(p.scan);
  if (scan == nullptr || p.index >= scan->slices.size()) return;
  if (scan->slices[p.index] == SliceOutcome::kLost) {
    TakeBackLoss(scan, p.index);
  } else {
    Close(scan, p.index, SliceOutcome::kSkipped);
  }
}

void SliceLedger::TakeBackLoss(Scan* scan, std::uint32_t index) {
  scan->slices[index] = SliceOutcome::kSkipped;
  ++scan->skipped;
  --accounts_.slices_lost;
  ++accounts_.slices_skipped;
  if (scan->booked == nullptr) return;
  --(accounts_.*(scan->booked));
  BookScan(scan);
}

/// Counts a slice before the origin as skipped. It is in the accounts only if Continue() has
/// counted it as lost.
void SliceLedger::SkipBeforeOrigin(SlicePosition p) {
  if (!skipped_before_origin_.insert(p).second || !previous_end_) return;
  if (!(*previous_end_ < p) && lost_before_end_.erase(p) == 0) return;
  --accounts_.slices_lost;
  ++accounts_.slices_skipped;
}

/// Returns the number of skipped scans between two scans, or 0 if the source has restarted its
/// numbers.
std::uint64_t SliceLedger::SkippedBetween(ScanId before, ScanId after) {
  const std::int64_t skipped =
      std::int64_t{SequenceDistance(after.id, before.id)} - (after.scan - before.scan);
  return static_cast<std::uint64_t>(std::max<std::int64_t>(skipped, 0));
}

void SliceLedger::BookScanId(std::int64_t scan, std::uint32_t id) {
  if (latest_id_ && scan <= latest_id_->scan) return;
  const ScanId now{scan, id};
  if (latest_id_) {
    accounts_.scans_skipped += SkippedBetween(*latest_id_, now);
  } else {
    first_id_ = now;
  }
  latest_id_ = now;
}

bool SliceLedger::BookedAsLost(SlicePosition p) const {
  if (p < origin_) {
    const bool in_outage = previous_end_ && *previous_end_ < p;
    return lost_before_end_.count(p) > 0 || (in_outage && skipped_before_origin_.count(p) == 0);
  }
  const Scan* scan = Find(p.scan);
  return scan != nullptr && p.index < scan->slices.size() &&
         scan->slices[p.index] == SliceOutcome::kLost;
}

std::optional<SlicePosition> SliceLedger::Overdue(Time now) const {
  std::optional<SlicePosition> limit;
  for (const Cutoff& c : cutoffs_) {
    if (c.time > now) break;
    limit = c.position;
  }
  return limit;
}

void SliceLedger::CloseFirst(Scan* scan, std::uint32_t limit) {
  const auto n = std::min(limit, static_cast<std::uint32_t>(scan->slices.size()));
  for (std::uint32_t i = 0; i < n; ++i) Close(scan, i, SliceOutcome::kLost);
}

void SliceLedger::CloseBefore(SlicePosition limit) {
  for (Scan* scan = nullptr; open_scan_ < limit.scan; ++open_scan_) {
    if ((scan = Find(open_scan_)) == nullptr) break;
    CloseFirst(scan, static_cast<std::uint32_t>(scan->slices.size()));
  }
  if (open_scan_ == limit.scan)
    if (Scan* scan = Find(open_scan_)) CloseFirst(scan, limit.index);
  for (; open_scan_ - first_scan_ > kKeptScans; ++first_scan_) scans_.pop_front();
  while (!cutoffs_.empty() && !(limit < cutoffs_.front().position)) cutoffs_.pop_front();
}

void SliceLedger::Finish() {
  if (!started()) return;
  CloseBefore({frontier_->scan, frontier_->index + 1});
  // Slices after the frontier may not have been sent, so they do not count as lost. But their scan
  // ends here and is counted.
  Scan* scan = Find(frontier_->scan);
  if (scan != nullptr && scan->open > 0) {
    BookScan(scan);
    scan->joined_late = true;  // so that the scan is not counted again
  }
}

void SliceLedger::Continue(const SliceLedger& previous) {
  if (!started() || !previous.started() || !(*previous.frontier_ < origin_)) return;
  if (latest_id_ && previous.latest_id_)
    accounts_.scans_skipped += SkippedBetween(*previous.latest_id_, first_id_);
  const std::uint64_t count = origin_count_;
  const SlicePosition last = *previous.frontier_;
  previous_end_ = last;
  accounts_ += previous.accounts_;
  auto at = previous.Before(last);
  for (int i = 0; i < kToldSlices && at; ++i, at = previous.Before(*at))
    if (previous.BookedAsLost(*at)) lost_before_end_.insert(*at);
  if (last.scan < origin_.scan) {
    const auto between = static_cast<std::uint64_t>(origin_.scan - last.scan - 1);
    accounts_.scans_lost += between;
    accounts_.slices_lost += between * count + origin_.index;
    // Finish() keeps the scan of the frontier, so scans_.back() is the scan of `last`.
    accounts_.slices_lost += previous.scans_.back().slices.size() - last.index - 1;
    if (Scan* scan = Find(origin_.scan)) scan->joined_late = false;
  } else {
    accounts_.slices_lost += origin_.index - last.index - 1;
  }
  for (const SlicePosition p : std::exchange(skipped_before_origin_, {})) SkipBeforeOrigin(p);
}

std::optional<SlicePosition> SliceLedger::Before(SlicePosition p) const {
  if (p.index > 0) return SlicePosition{p.scan, p.index - 1};
  if (p.scan <= origin_.scan) return SlicePosition{p.scan - 1, origin_count_ - 1};
  const Scan* scan = Find(p.scan - 1);
  if (scan == nullptr) return std::nullopt;
  return SlicePosition{p.scan - 1, static_cast<std::uint32_t>(scan->slices.size()) - 1};
}

SliceLedger::Scan* SliceLedger::Find(std::int64_t number) {
  return const_cast<Scan*>(std::as_const(*this).Find(number));
}

const SliceLedger::Scan* SliceLedger::Find(std::int64_t number) const {
  const std::int64_t i = number - first_scan_;
  if (i < 0 || i >= static_cast<std::int64_t>(scans_.size())) return nullptr;
  return &scans_[static_cast<std::size_t>(i)];
}

}  // namespace lidar::rtp
