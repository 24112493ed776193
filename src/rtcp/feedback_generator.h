// SPDX-License-Identifier: LGPL-2.1-or-later
// The receiver's side: records arrivals, and decides what to report when.
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
  DataSize size;  ///< on the wire, with IP header
};

struct FeedbackConfig {
  std::uint32_t sender_ssrc = 1;  ///< the receiver's own SSRC in the RTCP header
  NumReports num_reports = NumReports::kCount;
  /// Longest wait of a report after an unreported packet; at a high rate it is shorter.
  Duration feedback_interval = 40ms;
  /// Number of unreported packets of all SSRCs that make a report due.
  int packets_per_feedback = 16;
  bool report_on_marker = true;
  /// A report is due at once if arriving packets change between CE and not CE.
  bool report_on_ce_change = true;
  /// Least time from the last report to a report that is due for such a change.
  Duration ce_change_interval = 5ms;
  /// Number of packets of an SSRC that are reported again, so that a lost report costs nothing.
  int overlap = 32;
  /// Share of the received bytes that reports may use in shorter intervals.
  double feedback_fraction = 0.02;
  Duration min_feedback_interval = 5ms;
  /// Longest RTCP packet. The remainder goes into the next report, which is due at once.
  DataSize max_report = DataSize::Bytes(1200);
  /// Silence after which an SSRC is forgotten.
  Duration ssrc_timeout = 30s;
};

/// Decides when to report. The class has no clock: OnPacket() and NextDue() show when to call
/// Take(). Not thread-safe.
///
///     generator.OnPacket(arrival, packet);
///     while (auto report = generator.Take(now)) Send(BuildCcfb(*report, config.num_reports));
///     wait until generator.NextDue() or the next packet
///
/// Sent bytes never exceed received bytes: a spoofed sender cannot use the receiver to amplify.
class FeedbackGenerator {
 public:
  explicit FeedbackGenerator(const FeedbackConfig& config = {});

  /// `at` is the kernel's time if known. It should not be after the `now` of Take().
  void OnPacket(Time at, const ReceivedPacket& packet);
  /// Returns the time at which the next report is due, which may be in the past; Time::max() if no
  /// packet waits.
  Time NextDue() const { return clock_.ToCaller(due_); }
  /// Returns the report if one is due.
  std::optional<CongestionFeedback> Take(Time at);
  /// Forgets all packets, for a new peer.
  void Reset();
  /// Forgets the packets of an SSRC whose sender has restarted.
  void Forget(std::uint32_t ssrc);
  void set_config(const FeedbackConfig& config) { config_ = config; }

  struct Stats {
    std::uint64_t packets = 0;
    std::uint64_t ce_packets = 0;
    std::uint64_t duplicates = 0;
    std::uint64_t reordered = 0;
    std::uint64_t stale = 0;  ///< too old for any report
    std::uint64_t lost = 0;   ///< gaps so far; a late packet reduces the number
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
    std::int64_t next_report = 0;          // lowest packet that no report has covered
    std::int64_t lowest_new = 0;           // lowest packet that arrived since the last report
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
  SteadyTime clock_;  // the caller's clock; all times here are steady
  Time due_ = Time::max();
  std::optional<Time> last_report_;
  std::optional<bool> last_was_ce_;
  int unreported_ = 0;
  std::optional<Time> rate_since_;
  DataSize rate_bytes_;
  DataRate rate_;
};

}  // namespace lidar::rtcp
