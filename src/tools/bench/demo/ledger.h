// SPDX-License-Identifier: LGPL-2.1-or-later
// Collects what happened to each slice, from the records of the sender and of the receiver.
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "src/base/time.h"
#include "src/tools/bench/demo/cloud_compare.h"
#include "src/tools/bench/demo/cloud_frame.h"

namespace lidar::demo {

inline double Ms(std::int64_t ns) { return static_cast<double>(ns) / 1e6; }

/// The events of a slice. Each time is in nanoseconds since the Unix epoch, or 0 if the event has
/// not happened.
struct SliceLife {
  std::int64_t due = 0;  // sampling time of the slice's last column
  std::int64_t captured = 0;
  std::int64_t encoded = 0;
  std::int64_t received = 0;
  std::int64_t decoded = 0;
  std::uint64_t returns = 0;
  std::uint64_t bytes = 0;
  double encode_ms = 0;
  double decode_ms = 0;
  std::optional<Comparison> comparison;
};

/// Data that are older than this are late. The sender's queue has the same limit (max-queue-delay
/// of screamsink).
constexpr Duration kMaxAge = std::chrono::milliseconds(200);

using ScanLife = std::vector<SliceLife>;

struct ScanCounts {
  std::uint64_t captured = 0;  // scans whose slices have all left the source
  std::uint64_t skipped = 0;   // scans with a slice that was not encoded
  std::uint64_t sent = 0;
  std::uint64_t complete = 0;  // scans whose slices were all decoded
  // Complete scans of which each slice was decoded within kMaxAge of its last column.
  std::uint64_t in_time = 0;
  std::uint64_t slices_sent = 0;
  std::uint64_t slices_lost = 0;  // slices that were encoded but not decoded
};

class Ledger {
 public:
  /// Adds a record if its type is "captured", "encoded", "decoded" or "posed". Ignores other
  /// records, and records with an impossible slice number.
  void Add(const nlohmann::json& record);
  void Add(SliceKey key, const Comparison& comparison);

  /// Counts the scans and slices. A slice that was encoded after `settled` does not count as lost,
  /// because it may still be on its way. A scan that was captured after `settled` does not count as
  /// skipped.
  ScanCounts Count(std::int64_t settled = INT64_MAX) const;
  const std::map<std::uint32_t, ScanLife>& scans() const { return scans_; }
  /// Returns the time at which the receiver had the pose of each scan.
  const std::map<std::uint32_t, std::int64_t>& posed() const { return posed_; }
  const Comparison& total() const { return total_; }
  std::uint64_t compared_slices() const { return compared_slices_; }

 private:
  SliceLife* Find(SliceKey key);

  std::map<std::uint32_t, ScanLife> scans_;
  std::map<std::uint32_t, std::int64_t> posed_;
  Comparison total_;
  std::uint64_t compared_slices_ = 0;
};

}  // namespace lidar::demo
