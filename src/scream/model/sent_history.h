// SPDX-License-Identifier: LGPL-2.1-or-later
// Status update when sending and on feedback: which packets are in flight, acknowledged, marked,
// lost.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "src/base/sequence.h"
#include "src/base/time.h"
#include "src/base/units.h"
#include "src/scream/feedback/ccfb.h"
#include "src/scream/feedback/report_clock.h"

namespace lidar::scream {

struct SentRecord {
  int stream = 0;
  DataSize size;
  Time sent{};
  Ecn ecn = Ecn::kNotEct;
};

struct AckedPacket : SentRecord {
  std::uint32_t ssrc = 0;
  /// On the receiver's clock, unwrapped; absent where the report does not tell,
  /// and after Expire().
  std::optional<Time> arrival;
  Ecn arrived_ecn = Ecn::kNotEct;
  bool was_lost = false;
};

struct LostPacket : SentRecord {
  std::uint32_t ssrc = 0;
};

/// What one report brought that no earlier one had.
struct AckSummary {
  std::vector<AckedPacket> acked;  ///< in the order in which they were sent
  std::vector<LostPacket> lost;
  Time report{};  ///< when it was made, on the receiver's clock, unwrapped
  /// When the packets were sent that an earlier report had acknowledged without their CE mark.
  std::vector<Time> late_ce;
  /// The draft's: by how much the highest acknowledged sequence numbers moved on, lost ones
  /// included.
  DataSize bytes_newly_acked;
  DataSize bytes_newly_acked_ce;
  /// The newly acknowledged packet that was sent last tells it. The receiver's holding time is not
  /// in it, unless the receiver never tells that time.
  std::optional<Duration> rtt;
};

enum class HistoryResult { kApplied, kNothingNew, kImplausible, kNotOurs };

/// Validates a report whole before it believes any of it.
class SentHistory {
 public:
  void OnSent(std::uint32_t ssrc, std::uint16_t seq, const SentRecord& record);
  HistoryResult OnFeedback(Time now, const CongestionFeedback& feedback, AckSummary* summary);
  /// Declares lost what is overdue.
  void DetectLoss(Time now, std::vector<LostPacket>* lost);
  /// What was sent before `before` and is still unsettled no longer counts as in flight, nor ever
  /// as lost; it may still be acknowledged.
  void Expire(Time before);

  DataSize bytes_in_flight() const { return in_flight_; }
  /// When the packet was sent that has been in flight for longest.
  std::optional<Time> oldest_in_flight() const;
  /// As many packets of one SSRC are unsettled as its numbers can tell apart.
  bool full() const;
  void set_max_reordering_window(Duration d) { max_reordering_window_ = d; }
  std::uint64_t foreign_blocks() const { return foreign_blocks_; }

 private:
  enum class State : std::uint8_t { kOutstanding, kMissing, kLost, kExpired, kAcked };
  struct Packet {
    std::int64_t seq = 0;
    SentRecord record;
    State state = State::kOutstanding;
    bool ce = false;
    Time missing_since{};
  };
  struct Source {
    SequenceUnwrapper<std::uint16_t> unwrapper;
    std::int64_t highest_acked = -1;
    std::deque<Packet> packets;  // by seq
    std::vector<std::int64_t> missing;
    std::int64_t next_behind = -1;  // the successor of the last number that went backwards
    int behind = 0;                 // so many came in a row
    std::optional<Time> restarted;  // numbers began anew
  };

  void ForgetSilentSource();
  static bool StartsAgain(Source* source, std::int64_t seq);
  void StartAgain(Time now, std::uint16_t seq, Source* source);
  void Insert(Source* source, const Packet& packet);
  static bool OfBefore(Time now, const Source& source, const SsrcReport& block);
  void ExpireTails();
  static std::ptrdiff_t FirstFrom(const std::deque<Packet>& packets, std::int64_t seq);
  static Packet* Find(Source* source, std::int64_t seq);
  bool Plausible(Time now, Source* source, const SsrcReport& block) const;
  void Apply(Time now, const SsrcReport& block, Source* source, Time report, AckSummary* summary);
  void Acknowledge(Time now, const PacketMetric& metric, Time report, std::uint32_t ssrc,
                   Packet* packet, AckSummary* summary);
  void AdvanceHighest(Source* source, std::int64_t seq, AckSummary* summary);
  static void MarkMissing(Time now, Source* source, Packet* packet);
  void DecayReorderingWindow(Time now);
  static void Trim(Source* source, DataSize* in_flight);

  std::map<std::uint32_t, Source> sources_;
  ReportClock clock_;
  DataSize in_flight_;
  Time newest_acked_{};               // when it was sent
  bool arrivals_known_ = false;       // the peer tells arrival times
  std::optional<Time> newest_timed_;  // of this report: when the newest packet with a time was sent
  std::optional<Duration> held_;      // of this report: the shortest round trip with holding time
  Duration reordering_window_{0};
  Time last_reordering_{};
  Duration max_reordering_window_ = std::chrono::milliseconds(100);
  std::uint64_t foreign_blocks_ = 0;
};

}  // namespace lidar::scream
