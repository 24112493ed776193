// SPDX-License-Identifier: LGPL-2.1-or-later
// Follows one stream through outages and restarts of its sender, among packets of other streams.
#pragma once
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "src/rtp/reassembler.h"

namespace lidar::rtp {

struct ReceiverAccounts {
  SliceAccounts slices;
  PacketAccounts packets;
  std::uint64_t packets_received = 0;
  std::uint64_t configs_received = 0;
  std::uint64_t restarts = 0;  // of the sender: a new SSRC, or scan numbers that start again
  std::uint64_t outages = 0;   // the same stream went on after a gap of several scans
};

/// Moves to other scan numbers after several consecutive packets with them. Moves to another SSRC
/// after as many of its packets, but only if the old SSRC is silent. A move loses no packet of a
/// stream that began when the old one ended. During silence one whole slice that continues the
/// stream is enough, because a throttled sender's slices may be far apart.
class Receiver {
 public:
  explicit Receiver(Duration max_reorder_time) : max_reorder_time_(max_reorder_time) {}

  std::vector<ReceivedSlice> Push(const RtpPacket& packet);
  /// End of stream: counts incomplete slices as lost, and restarts with the next packet.
  void Finish();
  void set_max_reorder_time(Duration t);
  ReceiverAccounts accounts() const;
  std::optional<std::uint32_t> ssrc() const;
  /// Another SSRC, if kRivalPackets of its packets arrived during the stream.
  std::optional<std::uint32_t> rival() const { return rival_; }

  static constexpr unsigned kProbation = 3;          // packets
  static constexpr unsigned kProbationNoClock = 64;  // packets, if arrival times do not advance
  static constexpr Duration kSilentStream = std::chrono::milliseconds(100);
  static constexpr unsigned kRivalPackets = 100;
  static constexpr std::size_t kMaxRivals = 16;

 private:
  struct Stream {
    Stream(std::uint32_t s, Reassembler r) : ssrc(s), reassembler(std::move(r)) {}
    std::uint32_t ssrc;
    Reassembler reassembler;
    std::vector<ReceivedSlice> held;  // slices of a candidate
    std::uint16_t last_sequence = 0;
    Time last_arrival;
    unsigned streak = 0;  // packets since the active stream's last packet
    std::uint64_t packets = 0;
  };

  void Dispatch(const RtpPacket& packet, const std::vector<Unit>& units,
                std::vector<ReceivedSlice>* out);
  bool GoesOnWithCandidate(const RtpPacket& packet, const std::vector<Unit>& units) const;
  void NoteRival(std::uint32_t ssrc);
  void DropHeld();
  void PushToCandidate(const RtpPacket& packet, const std::vector<Unit>& units);
  bool CandidateHasWon(Time now) const;
  bool CandidateGoesOn(Time now) const;
  void Promote(Time now, std::vector<ReceivedSlice>* out);

  Duration max_reorder_time_;
  std::optional<Stream> active_;
  std::optional<Stream> candidate_;
  Time active_arrival_;
  std::map<std::uint32_t, unsigned> rivals_;  // SSRC to packets since the stream began
  std::optional<std::uint32_t> rival_;
  ReceiverAccounts booked_;  // of streams that ended
};

}  // namespace lidar::rtp
