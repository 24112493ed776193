// SPDX-License-Identifier: LGPL-2.1-or-later
// The receiver's side: remembers what arrived and decides when to report what.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "src/base/sequence.h"
#include "src/base/time.h"
#include "src/base/units.h"
#include "src/scream/feedback/ccfb.h"
#include "src/scream/steady_time.h"

namespace lidar::scream {
using namespace std::chrono_literals;

struct ReceivedPacket {
  std::uint32_t ssrc = 0;
  std::uint16_t seq = 0;
  Ecn ecn = Ecn::kNotEct;
  bool marker = false;
  DataSize size;  ///< as on the wire, IP included
};

struct FeedbackConfig {
  std::uint32_t sender_ssrc = 1;  ///< the receiver's own SSRC, in the RTCP header
  NumReports num_reports = NumReports::kCount;
  /// A report waits no longer than this after an unreported packet, and less at high rate.
  Duration feedback_interval = 40ms;
  /// A report is due after this many unreported packets of all SSRCs.
  int packets_per_feedback = 16;
  bool report_on_marker = true;
  /// A report is due at once when arriving packets change between CE and not CE...
  bool report_on_ce_change = true;
  /// ...but no sooner than this after the report before.
  Duration ce_change_interval = 5ms;
  /// A report reaches back over this many packets of an SSRC that were reported already, so that a
  /// lost report costs nothing.
  int overlap = 32;
  /// Share of the received bytes that shortening the interval may spend on reports.
  double feedback_fraction = 0.02;
  Duration min_feedback_interval = 5ms;
  /// Longest RTCP packet; what does not fit goes into the next report, due at once.
  DataSize max_report = DataSize::Bytes(1200);
  /// Forgets an SSRC after this silence.
  Duration ssrc_timeout = 30s;
};

/// No clock: OnPacket() and NextDue() tell when to call Take(). Not thread-safe.
///
///     generator.OnPacket(arrival, packet);
///     while (auto report = generator.Take(now)) Send(BuildCcfb(*report, config.num_reports));
///     wait until generator.NextDue() or the next packet
///
/// Sent bytes never exceed received bytes (a spoofed sender cannot use the receiver to amplify).
class FeedbackGenerator {
 public:
  explicit FeedbackGenerator(const FeedbackConfig& config = {});

  /// `at` is the kernel's time where known; it should not lie after the `now` of Take().
  void OnPacket(Time at, const ReceivedPacket& packet);
  /// When the next report is due (maybe in the past), Time::max() where nothing waits.
  Time NextDue() const { return clock_.ToCaller(due_); }
  /// The report, if one is due.
  std::optional<CongestionFeedback> Take(Time at);
  /// Forgets everything, for a new peer.
  void Reset();
  void set_config(const FeedbackConfig& config) { config_ = config; }

  struct Stats {
    std::uint64_t packets = 0;
    std::uint64_t ce_packets = 0;
    std::uint64_t duplicates = 0;
    std::uint64_t reordered = 0;
    std::uint64_t stale = 0;  ///< so old that no report covers them any more
    std::uint64_t lost = 0;   ///< gaps so far (a late packet takes its loss back)
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
    std::deque<Arrival> window;  // of first, first + 1, ...
    std::int64_t first = 0;
    std::int64_t next_report = 0;          // lowest one not yet covered by any report
    std::int64_t lowest_new = 0;           // lowest one that arrived since the last report
    std::optional<std::uint16_t> restart;  // where the sender would go on, had it jumped
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
  SteadyTime clock_;  // of the caller; all times here are its steady ones
  Time due_ = Time::max();
  std::optional<Time> last_report_;
  std::optional<bool> last_was_ce_;
  int unreported_ = 0;
  std::optional<Time> rate_since_;
  DataSize rate_bytes_;
  DataRate rate_;
};

}  // namespace lidar::scream
