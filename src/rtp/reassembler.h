// SPDX-License-Identifier: LGPL-2.1-or-later
// Reassembles the packets of a stream to slices; a lost packet costs its slice only.
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

/// An RTP packet as it came in.
struct RtpPacket {
  std::uint32_t ssrc = 0;
  std::uint16_t sequence = 0;
  Time arrival;             // of any clock that does not go back
  std::optional<Time> pts;  // passed on to the slice
  ByteView payload;
};

/// A whole slice, equal to the one that was sent.
struct ReceivedSlice {
  SliceId id;
  SliceInfo info;
  std::optional<Time> pts;  // of the slice's packet that arrived first
  std::shared_ptr<const StreamConfig> config;
  std::vector<std::uint8_t> bytes;
  bool discont = false;  // the first slice, or slices before it are lost
};

struct PacketAccounts {
  std::uint64_t invalid = 0;    // malformed, or contradicting earlier packets
  std::uint64_t duplicate = 0;  // of a packet or slice that has arrived
  std::uint64_t late = 0;       // of a slice that counts as lost, or that precedes the join
  std::uint64_t config_damaged = 0;
};

/// kMaxPendingBytes and kMaxPendingSlices bound the memory: the oldest slices are dropped first.
class Reassembler {
 public:
  explicit Reassembler(Duration max_reorder_time) : ledger_(max_reorder_time) {}
  /// For packets that may be of the stream of `before`, but with other scan numbers. Unwraps them
  /// from the newest number there.
  Reassembler(Duration max_reorder_time, const Reassembler& before)
      : ledger_(max_reorder_time), newest_scan_(before.newest_scan_) {}

  /// Returns true if the packet's scan numbers continue this stream, or if no slice has begun. One
  /// damaged header must not move the stream to other scan numbers.
  bool Continues(const std::vector<Unit>& units) const;
  /// Takes the units of `packet` and appends the slices that are now whole to `out`, in the order
  /// of their completion: no slice waits for another.
  void Push(const RtpPacket& packet, const std::vector<Unit>& units,
            std::vector<ReceivedSlice>* out);
  /// Returns true if the first slice here follows the last one of `previous` within `max_scans`
  /// scans.
  bool IsAfter(const Reassembler& previous, std::int64_t max_scans) const;
  /// Returns true if a slice was whole and undamaged, with or without its config.
  bool has_whole_slice() const { return has_whole_slice_; }
  /// Returns true if a slice has begun.
  bool started() const { return ledger_.started(); }
  /// Continues after `previous`, the same stream before an outage. Counts the slices of the outage
  /// as lost, takes over the configs, and appends the slices that waited for them.
  void GoOn(const Reassembler& previous, std::vector<ReceivedSlice>* out);
  /// The sender of `previous` restarted with the same SSRC. Takes over only configs that came after
  /// its last slice, because older ids may have a new meaning.
  void StartAnew(const Reassembler& previous, std::vector<ReceivedSlice>* out);
  /// Discards the accounts of the slices so far, and counts anew from the incomplete slices on.
  void JoinAnew(Time now);
  /// End of stream: incomplete slices are lost.
  void Finish();

  void set_max_reorder_time(Duration t) { ledger_.set_max_reorder_time(t); }
  const SliceAccounts& slices() const { return ledger_.accounts(); }
  const PacketAccounts& packets() const { return packets_; }
  std::uint64_t configs() const { return config_count_; }
  /// Memory that incomplete slices hold [bytes].
  std::size_t pending_bytes() const { return pending_bytes_; }

  static constexpr std::size_t kMaxPendingBytes = std::size_t{16} << 20;
  static constexpr std::size_t kMaxPendingSlices = 1024;
  static constexpr int kMaxScanJump = 2;
  static constexpr int kMaxScanBack = 64;

 private:
  struct Pending {
    FragmentBuffer fragments;
    std::optional<Time> pts;
    std::vector<std::uint8_t> bytes;  // once whole: waits for its config
  };
  struct KnownConfig {
    std::uint8_t id;
    std::shared_ptr<const StreamConfig> config;
    bool after_slices = true;  // came after the last slice
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
  std::int64_t newest_scan_ = 0;  // unwrapped
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
