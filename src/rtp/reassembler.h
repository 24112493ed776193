// SPDX-License-Identifier: LGPL-2.1-or-later
// Reassembles slices from the packets of a stream. If a packet is lost, only its slice is lost.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "src/base/time.h"
#include "src/rtp/fragment_buffer.h"
#include "src/rtp/payload_header.h"
#include "src/rtp/slice_ledger.h"
#include "src/rtp/stream_config.h"

namespace lidar::rtp {

/// A received RTP packet.
struct RtpPacket {
  std::uint32_t ssrc = 0;
  std::uint16_t sequence = 0;
  Time arrival;             // on any clock that never goes backwards
  std::optional<Time> pts;  // becomes the time of the slice
  ByteView payload;
};

/// A complete slice. Its bytes equal the bytes that were sent.
struct ReceivedSlice {
  SliceId id;
  SliceInfo info;
  std::optional<Time> pts;  // PTS of the slice's packet that arrived first
  std::shared_ptr<const StreamConfig> config;
  std::vector<std::uint8_t> bytes;
  bool discont = false;  // true for the first slice, and if slices before it are lost
};

struct PacketAccounts {
  std::uint64_t invalid = 0;    // malformed, or contradicts earlier packets
  std::uint64_t duplicate = 0;  // the packet or its slice has already arrived
  // The slice already counts as lost, or is older than the first slice.
  std::uint64_t late = 0;
  std::uint64_t config_damaged = 0;
};

/// Reassembles the slices of one stream. The memory is limited by kMaxPendingBytes and
/// kMaxPendingSlices: if there are more, the oldest slices are dropped.
class Reassembler {
 public:
  explicit Reassembler(Duration max_reorder_time) : ledger_(max_reorder_time) {}
  /// Creates a reassembler for packets that may belong to the stream of `before`, but have other
  /// scan numbers. Scan numbers are unwrapped relative to the newest number in `before`.
  Reassembler(Duration max_reorder_time, const Reassembler& before)
      : ledger_(max_reorder_time), newest_scan_(before.newest_scan_) {}

  /// Returns true if the scan numbers of a packet continue this stream, or if no slice has begun.
  /// Otherwise the packet must not be pushed, because a single damaged header must not change the
  /// scan numbers of the stream.
  bool Continues(const std::vector<Unit>& units) const;
  /// Processes the units of `packet`. Appends the slices that are complete now to `out`, in the
  /// order of their completion. A slice never waits for another slice.
  void Push(const RtpPacket& packet, const std::vector<Unit>& units,
            std::vector<ReceivedSlice>* out);
  /// Returns true if the first slice of this stream is after the last slice of `previous`, by at
  /// most `max_scans` scans.
  bool IsAfter(const Reassembler& previous, std::int64_t max_scans) const;
  /// Returns true if a slice was complete and undamaged, even if its config has not arrived.
  bool has_whole_slice() const { return has_whole_slice_; }
  /// Returns true if any slice has begun.
  bool started() const { return ledger_.started(); }
  /// Continues `previous`, which is the same stream before an outage. Counts the slices of the
  /// outage as lost and copies the configs. Appends to `out` the slices that waited for these
  /// configs.
  void GoOn(const Reassembler& previous, std::vector<ReceivedSlice>* out);
  /// Replaces `previous`, whose sender has restarted with the same SSRC. Copies only configs that
  /// arrived after the last slice of `previous`, because ids of older configs may have a new
  /// meaning.
  void StartAnew(const Reassembler& previous, std::vector<ReceivedSlice>* out);
  /// Resets the counts of slices, and starts to count with the slices that are incomplete now.
  void JoinAnew(Time now);
  /// Counts incomplete slices as lost, at the end of the stream.
  void Finish();

  void set_max_reorder_time(Duration t) { ledger_.set_max_reorder_time(t); }
  const SliceAccounts& slices() const { return ledger_.accounts(); }
  const PacketAccounts& packets() const { return packets_; }
  std::uint64_t configs() const { return config_count_; }
  /// Returns the memory that incomplete slices take [bytes].
  std::size_t pending_bytes() const { return pending_bytes_; }

  static constexpr std::size_t kMaxPendingBytes = std::size_t{16} << 20;
  static constexpr std::size_t kMaxPendingSlices = 1024;
  static constexpr int kMaxScanJump = 2;
  static constexpr int kMaxScanBack = 64;

 private:
  struct Pending {
    FragmentBuffer fragments;
    std::optional<Time> pts;
    std::vector<std::uint8_t> bytes;  // the complete slice, while it waits for its config
  };
  struct KnownConfig {
    std::uint8_t id;
    std::shared_ptr<const StreamConfig> config;
    bool after_slices = true;  // true if it arrived after the last slice
  };
  using PendingMap = std::map<SlicePosition, Pending>;

  std::int64_t Extend(std::uint32_t scan_number) const;
  void PushSlice(const RtpPacket& packet, const Unit& unit, std::vector<ReceivedSlice>* out);
  bool Admit(SlicePosition p, const RtpPacket& packet, const Unit& unit);
  void PushConfig(const RtpPacket& packet, const Unit& unit, std::vector<ReceivedSlice>* out);
  void Learn(std::uint8_t id, std::shared_ptr<const StreamConfig> config,
             std::vector<ReceivedSlice>* out);
  void TakeConfigs(const Reassembler& previous, bool all, std::vector<ReceivedSlice>* out);
  KnownConfig* FindKnown(std::uint8_t id);
  void Complete(PendingMap::iterator it, std::vector<ReceivedSlice>* out);
  void Emit(PendingMap::iterator it, std::shared_ptr<const StreamConfig> config,
            std::vector<ReceivedSlice>* out);
  void BookSkipped(SlicePosition p, std::uint64_t skipped);
  void Expire(Time now);
  void DropBefore(SlicePosition limit);
  PendingMap::iterator Remove(PendingMap::iterator it);
  void Bound();
  std::shared_ptr<const StreamConfig> FindConfig(std::uint8_t id) const;
  std::uint64_t Missing() const;

  SliceLedger ledger_;
  std::int64_t newest_scan_ = 0;  // unwrapped number of the newest scan
  bool has_whole_slice_ = false;
  PendingMap pending_;
  std::size_t pending_bytes_ = 0;
  FragmentBuffer config_fragments_;
  std::deque<KnownConfig> configs_;  // newest first
  std::uint64_t config_count_ = 0;
  std::optional<std::uint64_t> missing_at_last_slice_;
  PacketAccounts packets_;
};

}  // namespace lidar::rtp
