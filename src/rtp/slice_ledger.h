// SPDX-License-Identifier: LGPL-2.1-or-later
// Counts each slice exactly once: as received, damaged, without config, skipped by the sender, or
// lost.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "src/base/time.h"

namespace lidar::rtp {

/// The position of a slice in its stream. `scan` is the scan number, unwrapped.
struct SlicePosition {
  std::int64_t scan = 0;
  std::uint32_t index = 0;

  friend bool operator<(SlicePosition a, SlicePosition b) {
    return std::tie(a.scan, a.index) < std::tie(b.scan, b.index);
  }
  friend bool operator==(SlicePosition a, SlicePosition b) {
    return a.scan == b.scan && a.index == b.index;
  }
};

/// The counters of slices and scans. Each slice and scan after the first slice is counted in one of
/// them as soon as its outcome is known.
struct SliceAccounts {
  SliceAccounts& operator+=(const SliceAccounts& o);

  std::uint64_t slices_received = 0;
  std::uint64_t slices_lost = 0;
  std::uint64_t slices_damaged = 0;          // all packets arrived, but with wrong bytes
  std::uint64_t slices_config_mismatch = 0;  // complete, but their config never arrived
  std::uint64_t slices_skipped = 0;          // never sent
  std::uint64_t scans_complete = 0;          // all slices that were not skipped were received
  std::uint64_t scans_incomplete = 0;
  std::uint64_t scans_lost = 0;     // no slice was received
  std::uint64_t scans_skipped = 0;  // never sent, but numbered by the source
};

enum class SliceOutcome : std::uint8_t {
  kOpen,
  kReceived,
  kDamaged,
  kConfigMismatch,
  kSkipped,
  kLost
};
enum class Admission { kOpen, kSettled, kTooOld, kContradiction };

/// Decides when a slice is lost, and counts slices and scans. A slice is lost if it is still
/// incomplete `max_reorder_time` after a later slice began. Slices before the first admitted slice
/// do not count as lost, because the receiver joined the stream later.
class SliceLedger {
 public:
  explicit SliceLedger(Duration max_reorder_time) : max_reorder_time_(max_reorder_time) {}

  bool started() const { return frontier_.has_value(); }
  /// Returns whether a packet of this slice is still useful. A slice that is newer than the
  /// frontier becomes the new frontier.
  Admission Admit(SlicePosition p, std::uint32_t count, Time now);
  /// Sets the outcome of a slice that is still open.
  void Settle(SlicePosition p, SliceOutcome outcome);
  /// Counts the slice as skipped by the source. If it was counted as lost, corrects the counts.
  void Skip(SlicePosition p);
  /// Notes the number `id` that the source gave to `scan`. If the source skips scans, these numbers
  /// have gaps.
  void BookScanId(std::int64_t scan, std::uint32_t id);
  /// Returns the slice before `p`, or nothing if its scan is no longer stored. Scans before the
  /// first scan are assumed to have as many slices as the first scan.
  std::optional<SlicePosition> Before(SlicePosition p) const;

  /// Returns the position before which all open slices are late at the time `now`. CloseBefore()
  /// counts them.
  std::optional<SlicePosition> Overdue(Time now) const;
  /// Counts all open slices before `limit` as lost.
  void CloseBefore(SlicePosition limit);
  /// Resets all slices and counters.
  void StartAnew() { *this = SliceLedger(max_reorder_time_); }
  /// Counts all open slices up to the frontier as lost, at the end of the stream.
  void Finish();
  /// Continues the stream of `previous` after a long outage. `previous` must be finished. The scans
  /// between `previous` and the first slice of this ledger are counted as lost, and so are the
  /// slices before this first slice in its scan. The accounts of `previous` are added, because
  /// later slices may still announce that slices of `previous` were skipped.
  void Continue(const SliceLedger& previous);

  void set_max_reorder_time(Duration t) { max_reorder_time_ = t; }
  const SliceAccounts& accounts() const { return accounts_; }
  /// Returns the slice that was admitted first.
  SlicePosition origin() const { return origin_; }
  /// Returns the newest slice that was admitted.
  std::optional<SlicePosition> frontier() const { return frontier_; }

 private:
  struct Scan {
    std::vector<SliceOutcome> slices;
    std::uint32_t open = 0;
    std::uint32_t received = 0;
    std::uint32_t skipped = 0;
    bool count_known = false;  // false: guessed from another scan, because no packet has arrived
    bool joined_late = false;  // the receiver joined after the scan had begun
    std::uint64_t SliceAccounts::*booked = nullptr;  // the counter in which the scan was counted
  };
  struct ScanId {
    std::int64_t scan = 0;
    std::uint32_t id = 0;
  };
  struct Cutoff {
    Time time;
    SlicePosition position;
  };

  bool Contradicts(std::int64_t number, std::uint32_t count);
  void Start(SlicePosition p, std::uint32_t count);
  void AppendScans(std::int64_t up_to, std::uint32_t count);
  void Close(Scan* scan, std::uint32_t index, SliceOutcome outcome);
  void CloseFirst(Scan* scan, std::uint32_t limit);
  void BookScan(Scan* scan);
  void TakeBackLoss(Scan* scan, std::uint32_t index);
  void SkipBeforeOrigin(SlicePosition p);
  bool BookedAsLost(SlicePosition p) const;
  static std::uint64_t SkippedBetween(ScanId before, ScanId after);
  Scan* Find(std::int64_t number);
  const Scan* Find(std::int64_t number) const;

  Duration max_reorder_time_;
  std::deque<Scan> scans_;       // consecutive scans, starting with first_scan_
  std::int64_t first_scan_ = 0;  // the number of scans_.front()
  // Earlier scans are closed, but are kept, because later slices may announce that their slices
  // were skipped.
  std::int64_t open_scan_ = 0;
  SlicePosition origin_;  // the slice that was admitted first
  std::uint32_t origin_count_ = 1;
  std::set<SlicePosition> skipped_before_origin_;
  // The end of the stream that Continue() was called with, if any. Slices after this end, and the
  // slices in lost_before_end_, have been counted as lost.
  std::optional<SlicePosition> previous_end_;
  std::set<SlicePosition> lost_before_end_;  // lost slices near the end of that stream
  std::optional<SlicePosition> frontier_;
  ScanId first_id_{};  // valid if latest_id_ is set
  std::optional<ScanId> latest_id_;
  std::deque<Cutoff> cutoffs_;  // times and positions are both ascending
  SliceAccounts accounts_;
};

}  // namespace lidar::rtp
