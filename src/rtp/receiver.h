// SPDX-License-Identifier: LGPL-2.1-or-later
// Receives one stream, even if packets of other streams arrive on the same port. Handles outages
// and restarts of the sender.
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
  std::uint64_t restarts = 0;  // restarts of the sender: a new SSRC, or new scan numbers
  std::uint64_t outages = 0;   // gaps of several scans after which the same stream continued
};

/// Packets with another SSRC, or with other scan numbers, form a candidate for the stream to
/// receive. The receiver changes to other scan numbers after kProbation consecutive packets. It
/// changes to another SSRC after as many packets, but only if no packet of the old SSRC has arrived
/// for kSilentStream. The slices of the candidate are kept, so no packet is lost if the candidate
/// begins when the old stream ends. If the old stream is silent, one complete slice that continues
/// this stream is enough, because the slices of a throttled sender may be far apart.
class Receiver {
 public:
  explicit Receiver(Duration max_reorder_time) : max_reorder_time_(max_reorder_time) {}

  std::vector<ReceivedSlice> Push(const RtpPacket& packet);
  /// Counts incomplete slices as lost, at the end of the stream. The next packet starts a new
  /// stream.
  void Finish();
  void set_max_reorder_time(Duration t);
  ReceiverAccounts accounts() const;
  std::optional<std::uint32_t> ssrc() const;
  /// Returns another SSRC if kRivalPackets of its packets have arrived during the stream.
  std::optional<std::uint32_t> rival() const { return rival_; }

  static constexpr unsigned kProbation = 3;  // number of packets
  // The number of packets if arrival times do not advance.
  static constexpr unsigned kProbationNoClock = 64;
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
    unsigned streak = 0;  // number of packets since the active stream's last packet
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
  std::map<std::uint32_t, unsigned> rivals_;  // number of packets by SSRC, since the stream began
  std::optional<std::uint32_t> rival_;
  ReceiverAccounts booked_;  // the counts of streams that have ended
};

}  // namespace lidar::rtp
