// SPDX-License-Identifier: LGPL-2.1-or-later
// The receiver's side: records arrivals, and decides when to report which packets.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "src/base/sequence.h"
#include "src/base/steady_time.h"
#include "src/base/time.h"
#include "src/base/units.h"
#include "src/rtcp/ccfb.h"

namespace lidar::rtcp {
using namespace std::chrono_literals;

struct ReceivedPacket {
  std::uint32_t ssrc = 0;
  std::uint16_t seq = 0;
  Ecn ecn = Ecn::kNotEct;
  bool marker = false;
  DataSize size;  ///< on the wire, including the IP header
};

struct FeedbackConfig {
  std::uint32_t sender_ssrc = 1;  ///< the receiver's own SSRC in the RTCP header
  NumReports num_reports = NumReports::kCount;
  /// The longest time from the arrival of a packet to its report. At a high rate, the time is
  /// shorter.
  Duration feedback_interval = 40ms;
  /// A report is due when this many packets, of all SSRCs together, are unreported.
  int packets_per_feedback = 16;
  bool report_on_marker = true;
  /// If true, a report is due at once when the arriving packets change between CE and not CE.
  bool report_on_ce_change = true;
  /// The least time from the last report to a report that is due because of such a change.
  Duration ce_change_interval = 5ms;
  /// The number of packets of each SSRC that are reported again, so that the loss of a report does
  /// no harm.
  int overlap = 32;
  /// The fraction of the received bytes that reports may use at intervals shorter than
  /// feedback_interval.
  double feedback_fraction = 0.02;
  Duration min_feedback_interval = 5ms;
  /// The greatest size of an RTCP packet. Packets that do not fit are in the next report, which is
  /// due at once.
  DataSize max_report = DataSize::Bytes(1200);
  /// An SSRC is forgotten if it has been silent for this time.
  Duration ssrc_timeout = 30s;
};

/// Records arrivals, and decides when to report them. The class has no clock: NextDue() returns the
/// time at which to call Take(). Not thread-safe.
///
///     generator.OnPacket(arrival, packet);
///     while (auto report = generator.Take(now)) Send(BuildCcfb(*report, config.num_reports));
///     wait until generator.NextDue() or the next packet
///
/// The reports never have more bytes than the received packets. An attacker who sends packets with
/// a forged source address can therefore not use the receiver to amplify its traffic.
class FeedbackGenerator {
 public:
  explicit FeedbackGenerator(const FeedbackConfig& config = {});

  /// Records an arrival. `at` is the arrival time of the kernel if it is known. It should not be
  /// later than the time of the next Take().
  void OnPacket(Time at, const ReceivedPacket& packet);
  /// Returns the time at which the next report is due, which may be in the past, or Time::max() if
  /// there is nothing to report.
  Time NextDue() const { return clock_.ToCaller(due_); }
  /// Returns a report, or nothing if no report is due.
  std::optional<CongestionFeedback> Take(Time at);
  /// Forgets all packets. Call it for a new peer.
  void Reset();
  /// Forgets the packets of an SSRC. Call it when the sender of `ssrc` has restarted.
  void Forget(std::uint32_t ssrc);
  void set_config(const FeedbackConfig& config) { config_ = config; }

  struct Stats {
    std::uint64_t packets = 0;
    std::uint64_t ce_packets = 0;
    std::uint64_t duplicates = 0;
    std::uint64_t reordered = 0;
    std::uint64_t stale = 0;  ///< too old for any report
    std::uint64_t lost = 0;   ///< missing packets so far; a late packet reduces the number
    std::uint64_t reports = 0;
    DataSize received;
    DataSize sent;
  };
  const Stats& stats() const { return stats_; }

 private:
  struct Arrival {
    bool received = false;
    Ecn ecn = Ecn::kNotEct;
    Time time{};
  };
  struct Source {
    SequenceUnwrapper<std::uint16_t> unwrapper;
    std::deque<Arrival> window;  // of packets first, first + 1, ...
    std::int64_t first = 0;
    std::int64_t next_report = 0;          // number of the first packet that no report has covered
    std::int64_t lowest_new = 0;           // lowest number that arrived since the last report
    std::optional<std::uint16_t> restart;  // next number if the sender has restarted
    int unreported = 0;
    Time last_arrival{};

    std::int64_t end() const { return first + static_cast<std::int64_t>(window.size()); }
  };

  Source* Find(Time arrival, std::uint32_t ssrc, std::uint16_t seq);
  void Start(Source* source, std::uint16_t seq);
  std::optional<std::int64_t> Locate(Source* source, std::uint16_t seq);
  bool Store(Source* source, std::int64_t seq, Time arrival, Ecn ecn);
  void Trim(Source* source) const;
  void Schedule(Time arrival, const ReceivedPacket& packet);
  void MeasureRate(Time arrival, DataSize size);
  Duration Interval() const;
  std::int64_t Allowance() const;
  std::int64_t FirstToReport(const Source& source, std::int64_t max_metrics) const;
  std::int64_t AppendBlock(Time now, std::uint32_t ssrc, Source* source, std::int64_t room,
                           CongestionFeedback* report);

  FeedbackConfig config_;
  std::map<std::uint32_t, Source> sources_;
  Stats stats_;
  SteadyTime clock_;  // converts the caller's times to steady times
  Time due_ = Time::max();
  std::optional<Time> last_report_;
  std::optional<bool> last_was_ce_;
  int unreported_ = 0;
  std::optional<Time> rate_since_;
  DataSize rate_bytes_;
  DataRate rate_;
};

}  // namespace lidar::rtcp
