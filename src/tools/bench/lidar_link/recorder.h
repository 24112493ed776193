// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes the output of lidar-link: a log of the packets, the live lines, and the summary.
#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/time.h"
#include "src/link/bottleneck.h"
#include "src/tools/common/distribution.h"
#include "src/tools/common/output_file.h"

namespace lidar::tools {

/// A packet that the link has delivered or dropped.
struct PacketRecord {
  link::Outcome outcome;
  Ecn ecn_in = Ecn::kNotEct;
  std::size_t flow = 0;
  ByteView payload;
};

class Recorder {
 public:
  /// `log` is the name of a file, or empty for no log. Throws std::runtime_error if the file cannot
  /// be written.
  explicit Recorder(const std::string& log);
  /// Closes the log. Throws std::runtime_error if a part of the log could not be written.
  void Close() { log_.Close(); }

  void Start(Time origin, Duration unix_offset);
  void OnPacket(const PacketRecord& record);
  void OnFeedback(bool delivered, std::size_t bytes);
  /// Notes that a packet was sent `late` after the time that the model computed for it.
  void OnLateness(Duration late) { lateness_.Add(Milliseconds(late)); }
  void OnRefusedSend() { ++refused_sends_; }

  /// Returns the figures since the last call of Live(), which must have been earlier than `now`.
  nlohmann::ordered_json Live(Time now, const link::Bottleneck& there,
                              const link::Capacity& capacity);
  nlohmann::ordered_json Summary(Time now, const link::Bottleneck* there,
                                 const link::Capacity& capacity) const;

 private:
  struct Counts {
    std::uint64_t packets = 0;
    std::uint64_t bytes = 0;
    std::uint64_t dropped = 0;
    std::uint64_t marked = 0;
  };

  OutputFile log_;
  Time origin_;
  Duration unix_offset_{0};
  Time live_since_;
  Counts live_;
  Distribution live_sojourn_;
  Distribution sojourn_;
  Distribution lateness_;
  std::vector<Counts> flows_;
  std::array<std::uint64_t, 4> ecn_in_{};
  std::array<std::uint64_t, 4> ecn_out_{};
  std::uint64_t feedback_packets_ = 0;
  std::uint64_t feedback_bytes_ = 0;
  std::uint64_t feedback_lost_ = 0;
  std::uint64_t refused_sends_ = 0;
};

}  // namespace lidar::tools
