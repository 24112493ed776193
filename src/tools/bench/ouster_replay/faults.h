// SPDX-License-Identifier: LGPL-2.1-or-later
// Injects faults between the sensor and the receiver on request, and counts them.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "src/tools/bench/ouster_replay/packet_stream.h"

namespace lidar::tools {

struct Faults {
  double loss = 0;  // this and the next three are shares of the lidar packets, from 0 to 1
  double reorder = 0;
  double duplicate = 0;
  double corrupt = 0;
  bool silent = false;      // no packets are sent
  bool wrong_size = false;  // packets are cut to half their size
  int http_status = 0;      // status of each answer; 0: no fault
  int http_delay_ms = 0;

  /// Sets the fields that `change` names, and returns an empty text. If a name or a value is wrong,
  /// sets no field and returns the error.
  std::string Merge(const nlohmann::json& change);
};

struct FaultCounts {
  std::uint64_t sent = 0;  // number of lidar packets, including duplicates
  std::uint64_t lost = 0;
  std::uint64_t reordered = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t corrupted = 0;
  std::uint64_t silenced = 0;
  std::uint64_t imu_sent = 0;

  nlohmann::ordered_json ToJson() const;
};

class FaultInjector {
 public:
  explicit FaultInjector(std::uint64_t seed) : random_(seed) {}
  /// Returns the packets to send in place of `packet`.
  std::vector<OutPacket> Apply(const Faults& faults, OutPacket packet);
  /// Returns the packet that was held back for reordering, if there is one. Must be called at the
  /// end of a stream.
  std::vector<OutPacket> Finish();
  const FaultCounts& counts() const { return counts_; }

 private:
  bool Chance(double probability);

  std::mt19937_64 random_;
  std::optional<OutPacket> held_;  // held back, and sent after the next packet
  FaultCounts counts_;
};

}  // namespace lidar::tools
