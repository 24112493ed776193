// SPDX-License-Identifier: LGPL-2.1-or-later
// Books every slice exactly once: received, damaged, without a config, skipped by the sender, or
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

/// Place of a slice in its stream; `scan` is the unwrapped scan number.
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

/// Each slice and each scan from the first one seen on is in one of its counters once it settles.
struct SliceAccounts {
  SliceAccounts& operator+=(const SliceAccounts& o);

  std::uint64_t slices_received = 0;
  std::uint64_t slices_lost = 0;
  std::uint64_t slices_damaged = 0;          // all packets there, but not the bytes that were sent
  std::uint64_t slices_config_mismatch = 0;  // whole, but no config with their id came
  std::uint64_t slices_skipped = 0;          // never sent
  std::uint64_t scans_complete = 0;          // but for slices that were skipped
  std::uint64_t scans_incomplete = 0;
  std::uint64_t scans_lost = 0;     // no slice received
  std::uint64_t scans_skipped = 0;  // never sent: of scans that the source numbered
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

/// A slice is lost once one behind it was seen `max_reorder_time` ago. The first slice admitted is
/// where the receiver joined: what was sent before it is not missing.
class SliceLedger {
 public:
  explicit SliceLedger(Duration max_reorder_time) : max_reorder_time_(max_reorder_time) {}

  bool started() const { return frontier_.has_value(); }
  /// May a packet of this slice still be used? kOpen moves the frontier.
  Admission Admit(SlicePosition p, std::uint32_t count, Time now);
  /// The slice, which must be open, has come to its end.
  void Settle(SlicePosition p, SliceOutcome outcome);
  /// The source never sent this slice. A slice that is booked as lost already moves to the skipped.
  void Skip(SlicePosition p);
  /// Notes the source's number `id` of `scan`. Between two sent scans these numbers have gaps for
  /// scans that were left out.
  void BookScanId(std::int64_t scan, std::uint32_t id);
  /// The slice before `p`; nothing if the ledger no longer has its scan. Scans before the first one
  /// count as having as many slices.
  std::optional<SlicePosition> Before(SlicePosition p) const;

  /// Slices before this position are late at `now`; CloseBefore books them.
  std::optional<SlicePosition> Overdue(Time now) const;
  /// All open slices before `limit` are lost.
  void CloseBefore(SlicePosition limit);
  /// End of stream: all open slices up to the frontier are lost.
  void Finish();
  /// Goes on after a long outage of the same stream. `previous` is finished. The scans between it
  /// and this ledger's first slice are lost, and so is the beginning of this ledger's first scan.
  /// The accounts of `previous` become a part of these, as word of its slices may still come.
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
    bool count_known = false;  // else taken from its neighbour: no packet of it came
    bool joined_late = false;  // its beginning was sent before the receiver joined
    std::uint64_t SliceAccounts::*booked = nullptr;  // where it counts, once it is closed
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
  std::int64_t open_scan_ = 0;   // all scans before are closed, and kept for word of skipped slices
  SlicePosition origin_;         // the first slice
  std::uint32_t origin_count_ = 1;
  std::set<SlicePosition> skipped_before_origin_;
  // This stream may go on with an earlier one. Slices behind the end of that are lost, and so are
  // the ones named here.
  std::optional<SlicePosition> previous_end_;
  std::set<SlicePosition> lost_before_end_;  // the last ones
  std::optional<SlicePosition> frontier_;
  ScanId first_id_{};  // where there is a latest one
  std::optional<ScanId> latest_id_;
  std::deque<Cutoff> cutoffs_;  // both times and positions ascend
  SliceAccounts accounts_;
};

}  // namespace lidar::rtp
