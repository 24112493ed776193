// SPDX-License-Identifier: LGPL-2.1-or-later
// All measurements of a run of the demo.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/tools/bench/demo/ledger.h"
#include "src/tools/bench/demo/run_options.h"

namespace lidar::demo {

/// A packet in the log of a link.
struct LinkPacket {
  double time_s = 0;  // time of arrival at the link
  std::int64_t size = 0;
  bool delivered = false;
  bool marked = false;
  double sojourn_ms = 0;
  std::size_t link = 0;
  std::int64_t unix_ns = 0;  // time of arrival at the link
};

/// Statistics of the sender and the encoder at one time.
struct SenderSample {
  std::int64_t unix_ns = 0;
  double target_bps = 0;
  double estimated_capacity_bps = 0;  // capacity of the path; 0: unknown
  double rtt_ms = 0;
  double queue_delay_ms = 0;
  double ref_wnd_bytes = 0;
  double bytes_in_flight = 0;
  double sender_queue_ms = 0;
  double step_m = 0;
  std::uint64_t packets_dropped = 0;  // packets that the sender's own queue dropped
};

/// Reads a "stats" record of the sender. A value that the elements do not have stays 0.
SenderSample ReadSample(const nlohmann::json& record);

/// Reads the log of a link. Leaves out lines that are cut off or malformed.
std::vector<LinkPacket> ReadLinkLog(const std::string& file);
/// Returns the packets of all links, in the order of their arrival. Their `time_s` counts from the
/// origin of the first link that has packets.
std::vector<LinkPacket> ReadLinkLogs(const RunOptions& options);

struct Measurements {
  RunOptions options;
  std::int64_t origin_unix_ns = 0;  // time of the first packet, which is time 0 of every plot
  double ran_s = 0;
  Ledger ledger;
  std::vector<LinkPacket> packets;
  std::vector<SenderSample> samples;
  // The means over time of the encoder's bitrate bounds; 0: unknown. The encoder predicts the
  // bounds from its slices. After a gap of the link, slices are coarse, and then the bounds are
  // only guesses.
  double encoder_min_bps = 0;
  double encoder_max_bps = 0;
  /// The latest bitrate bounds, and the time since which they hold.
  struct {
    std::int64_t since_unix_ns = 0;
    double min_bps = 0, max_bps = 0;
    double known_s = 0;  // total time for which bounds were known; needed for the means
  } bounds;
  nlohmann::json sender_stats;  // last record of the sender
  nlohmann::json receiver_stats;

  /// Notes new bounds. They hold until the next call of AddBounds() or EndBounds().
  void AddBounds(std::int64_t unix_ns, double min_bps, double max_bps);
  void EndBounds(std::int64_t unix_ns);
  double Since(std::int64_t unix_ns) const {
    return static_cast<double>(unix_ns - origin_unix_ns) / 1e9;
  }
  /// Returns false in the first 3 s of the run, and for 1 s after each step of the capacity.
  bool IsSteady(double time_s) const;
};

/// Returns the sender's statistics of each link. The list is empty if there is only one link.
nlohmann::json LinkStats(const Measurements& m);

/// Adds up the `lines` that the links printed for the same second. Queues are not added up; the
/// result has the longest of them. An item of `lines` is null if the link has not printed a line
/// yet.
nlohmann::json SumOfLinks(const std::vector<nlohmann::json>& lines);

}  // namespace lidar::demo
