// SPDX-License-Identifier: LGPL-2.1-or-later
// Records which packets are in flight, acknowledged, marked or lost.
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
#include "src/rtcp/ccfb.h"
#include "src/rtcp/report_clock.h"

namespace lidar::scream {

struct SentRecord {
  int stream = 0;
  DataSize size;
  Time sent{};
  Ecn ecn = Ecn::kNotEct;
};

struct AckedPacket : SentRecord {
  /// The arrival time on the receiver's clock, unwrapped. It is unset if the report has no time, or
  /// if the packet was acknowledged after Expire().
  std::optional<Time> arrival;
  Ecn arrived_ecn = Ecn::kNotEct;
  bool was_lost = false;
  bool expired = false;  ///< acknowledged after Expire()
};

/// The new information of a report.
struct AckSummary {
  std::vector<AckedPacket> acked;  ///< in the order of sending
  std::vector<SentRecord> lost;
  Time report{};  ///< time of the report on the receiver's clock, unwrapped
  /// The sending times of packets whose CE mark is in this report, although an earlier report
  /// already acknowledged them.
  std::vector<Time> late_ce;
  /// The draft's bytes_newly_acked: for each SSRC, the bytes of all packets from the last highest
  /// acknowledged number to the new one. Lost packets count, too.
  DataSize bytes_newly_acked;
  DataSize bytes_newly_acked_ce;
  /// The round trip of the newest acknowledged packet. If the receiver reports how long it held the
  /// acknowledgement, this time is subtracted.
  std::optional<Duration> rtt;
};

enum class FeedbackResult {
  kAccepted,     ///< counted; decisions may have changed
  kImplausible,  ///< ignored as a whole: packets that were not sent, or impossible times
  kNotOurs,      ///< has no block for our SSRCs
  kStale,        ///< has nothing new
};

/// Records sent packets. A report is checked as a whole before it changes the records.
class SentHistory {
 public:
  void OnSent(std::uint32_t ssrc, std::uint16_t seq, const SentRecord& record);
  FeedbackResult OnFeedback(Time now, const rtcp::CongestionFeedback& feedback,
                            AckSummary* summary);
  /// Gives up the packets that were sent before `before`. They no longer count as in flight or as
  /// lost, but may still be acknowledged.
  void Expire(Time before);

  DataSize bytes_in_flight() const { return in_flight_; }
  /// Returns the sending time of the packet that has been in flight for longest.
  std::optional<Time> oldest_in_flight() const;
  /// Returns true if an SSRC has as many packets in flight as its sequence numbers can distinguish.
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
    std::deque<Packet> packets;  // in the order of seq
    std::vector<std::int64_t> missing;
    std::int64_t next_behind = -1;  // successor of the last number that went backwards
    int behind = 0;                 // consecutive numbers that went backwards
    std::optional<Time> restarted;  // time of the last restart of the numbers
  };

  void ForgetSilentSource();
  static bool StartsAgain(Source* source, std::int64_t seq);
  void StartAgain(Time now, std::uint16_t seq, Source* source);
  void Insert(Source* source, const Packet& packet);
  std::optional<Duration> RoundTrip(Time now, const AckSummary& summary) const;
  static bool OfBefore(Time now, const Source& source, const rtcp::SsrcReport& block);
  void ExpireTails();
  static std::ptrdiff_t FirstFrom(const std::deque<Packet>& packets, std::int64_t seq);
  static Packet* Find(Source* source, std::int64_t seq);
  bool Plausible(Time now, Source* source, const rtcp::SsrcReport& block) const;
  void Apply(Time now, const rtcp::SsrcReport& block, Source* source, AckSummary* summary);
  void Acknowledge(Time now, const rtcp::PacketMetric& metric, Packet* packet, AckSummary* summary);
  DataSize Settle(Source* source, std::int64_t seq);
  static void MarkMissing(Time now, Source* source, Packet* packet);
  void DecayReorderingWindow(Time now);
  void DetectLoss(Time now, std::vector<SentRecord>* lost);
  void Trim(Source* source);

  std::map<std::uint32_t, Source> sources_;
  rtcp::ReportClock clock_;
  DataSize in_flight_;
  Time newest_acked_{};          // sending time of the newest acknowledged packet
  bool arrivals_known_ = false;  // the peer reports arrival times
  Duration reordering_window_{0};
  Time last_reordering_{};
  Duration max_reordering_window_ = std::chrono::milliseconds(100);
  std::uint64_t foreign_blocks_ = 0;
};

}  // namespace lidar::scream
