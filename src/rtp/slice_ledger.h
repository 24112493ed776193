// SPDX-License-Identifier: LGPL-2.1-or-later
// Counts each slice exactly once: received, damaged, without config, skipped by the sender, or
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

/// Position of a slice in its stream; `scan` is the unwrapped scan number.
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

/// Each slice and scan since the first one is in one of the counters once its outcome is known.
struct SliceAccounts {
  SliceAccounts& operator+=(const SliceAccounts& o);

  std::uint64_t slices_received = 0;
  std::uint64_t slices_lost = 0;
  std::uint64_t slices_damaged = 0;          // all packets came, but their bytes are wrong
  std::uint64_t slices_config_mismatch = 0;  // whole, but without a config of their id
  std::uint64_t slices_skipped = 0;          // never sent
  std::uint64_t scans_complete = 0;          // all slices received, except for skipped ones
  std::uint64_t scans_incomplete = 0;
  std::uint64_t scans_lost = 0;     // no slice received
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

/// A slice is lost `max_reorder_time` after a later one began. The receiver joins with the first
/// admitted slice, so earlier slices do not count as lost.
class SliceLedger {
 public:
  explicit SliceLedger(Duration max_reorder_time) : max_reorder_time_(max_reorder_time) {}

  bool started() const { return frontier_.has_value(); }
  /// Returns whether a packet of this slice is still useful. A newer slice moves the frontier.
  Admission Admit(SlicePosition p, std::uint32_t count, Time now);
  /// Sets the outcome of an open slice.
  void Settle(SlicePosition p, SliceOutcome outcome);
  /// Counts the slice as skipped by the source, even if it was counted as lost.
  void Skip(SlicePosition p);
  /// Notes the source's number `id` of `scan`. These numbers have gaps for skipped scans.
  void BookScanId(std::int64_t scan, std::uint32_t id);
  /// Returns the slice before `p`, or nothing if its scan is forgotten. Scans before the first scan
  /// are assumed to have as many slices as the first.
  std::optional<SlicePosition> Before(SlicePosition p) const;

  /// Returns the position before which slices are late at `now`; CloseBefore() counts them.
  std::optional<SlicePosition> Overdue(Time now) const;
  /// Counts all open slices before `limit` as lost.
  void CloseBefore(SlicePosition limit);
  /// Forgets all slices and counters.
  void StartAnew() { *this = SliceLedger(max_reorder_time_); }
  /// End of stream: all open slices up to the frontier are lost.
  void Finish();
  /// Continues after a long outage of the same stream. `previous` is finished. Scans between it and
  /// this ledger's first slice are lost, and so is the beginning of the first scan here. The
  /// accounts of `previous` are added, because later slices may still announce skipped slices of
  /// `previous`.
  void Continue(const SliceLedger& previous);

  void set_max_reorder_time(Duration t) { max_reorder_time_ = t; }
  const SliceAccounts& accounts() const { return accounts_; }
  /// The first slice admitted.
  SlicePosition origin() const { return origin_; }
  /// The newest slice seen.
  std::optional<SlicePosition> frontier() const { return frontier_; }

 private:
  struct Scan {
    std::vector<SliceOutcome> slices;
    std::uint32_t open = 0;
    std::uint32_t received = 0;
    std::uint32_t skipped = 0;
    bool count_known = false;  // false: guessed from a neighbour, without a packet
    bool joined_late = false;  // its beginning was sent before the receiver joined
    std::uint64_t SliceAccounts::*booked = nullptr;  // counter to which the scan was added
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
  std::deque<Scan> scans_;       // without gaps, from first_scan_
  std::int64_t first_scan_ = 0;  // number of scans_.front()
  std::int64_t open_scan_ = 0;   // earlier scans are closed; later slices may announce skipped ones
  SlicePosition origin_;         // the first slice
  std::uint32_t origin_count_ = 1;
  std::set<SlicePosition> skipped_before_origin_;
  // The end of the earlier stream that this one continues, if any. Slices after it and the slices
  // in lost_before_end_ are lost.
  std::optional<SlicePosition> previous_end_;
  std::set<SlicePosition> lost_before_end_;  // lost slices among the last ones of that stream
  std::optional<SlicePosition> frontier_;
  ScanId first_id_{};  // valid if latest_id_ is set
  std::optional<ScanId> latest_id_;
  std::deque<Cutoff> cutoffs_;  // both times and positions ascend
  SliceAccounts accounts_;
};

}  // namespace lidar::rtp
