// SPDX-License-Identifier: LGPL-2.1-or-later
// Everything a run of the demo measured.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/tools/bench/demo/ledger.h"
#include "src/tools/bench/demo/run_options.h"

namespace lidar::demo {

/// A line of a link's log.
struct LinkPacket {
  double time_s = 0;  // arrival at the link
  std::int64_t size = 0;
  bool delivered = false;
  bool marked = false;
  double sojourn_ms = 0;
  std::size_t link = 0;
  std::int64_t unix_ns = 0;  // arrival at the link
};

/// Statistics of the sender and the encoder at one time.
struct SenderSample {
  std::int64_t unix_ns = 0;
  double target_bps = 0;
  double estimated_capacity_bps = 0;  // of the path; 0: unknown
  double rtt_ms = 0;
  double queue_delay_ms = 0;
  double ref_wnd_bytes = 0;
  double bytes_in_flight = 0;
  double sender_queue_ms = 0;
  double step_m = 0;
  std::uint64_t packets_dropped = 0;  // by the sender's own queue
};

/// Reads a `stats` record of the sender. Fields that an element does not have stay 0.
SenderSample ReadSample(const nlohmann::json& record);

/// Reads a link's log. Lines that are cut off or malformed are left out.
std::vector<LinkPacket> ReadLinkLog(const std::string& file);
/// Packets of all links, in the order of their arrival. Their time_s counts from the origin of the
/// first link with packets.
std::vector<LinkPacket> ReadLinkLogs(const RunOptions& options);

struct Measurements {
  RunOptions options;
  std::int64_t origin_unix_ns = 0;  // the first packet: time 0 of every plot
  double ran_s = 0;
  Ledger ledger;
  std::vector<LinkPacket> packets;
  std::vector<SenderSample> samples;
  // Means over time of the encoder's bitrate bounds; 0: unknown. The encoder predicts the bounds
  // from its slices. While slices are coarse after a gap of the link, the bounds are guesses.
  double encoder_min_bps = 0;
  double encoder_max_bps = 0;
  /// The latest bitrate bounds, and since when they hold.
  struct {
    std::int64_t since_unix_ns = 0;
    double min_bps = 0, max_bps = 0;
    double known_s = 0;  // how long bounds were known, for the means
  } bounds;
  nlohmann::json sender_stats;  // the last record of each program
  nlohmann::json receiver_stats;

  /// The bounds hold until the next call, or until the stream ends.
  void AddBounds(std::int64_t unix_ns, double min_bps, double max_bps);
  void EndBounds(std::int64_t unix_ns);
  double Since(std::int64_t unix_ns) const {
    return static_cast<double>(unix_ns - origin_unix_ns) / 1e9;
  }
  /// Returns false in the first 3 s, and for 1 s after a step of the capacity.
  bool IsSteady(double time_s) const;
};

/// The sender's statistics of each link; empty for a single link.
nlohmann::json LinkStats(const Measurements& m);

/// Adds up the links' `lines` of one second, but takes the longest queue. An item is null if its
/// link has no line.
nlohmann::json SumOfLinks(const std::vector<nlohmann::json>& lines);

}  // namespace lidar::demo
