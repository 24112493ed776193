// SPDX-License-Identifier: LGPL-2.1-or-later
// The life of every slice, put together from the records of both ends.
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

/// Times are nanoseconds since the Unix epoch; 0: has not happened.
struct SliceLife {
  std::int64_t due = 0;  // sampling time of the last column
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

/// Older data are late, as in the sender's queue (max-queue-delay of screamsink).
constexpr Duration kMaxAge = std::chrono::milliseconds(200);

using ScanLife = std::vector<SliceLife>;

struct ScanCounts {
  std::uint64_t captured = 0;  // all slices left the source
  std::uint64_t skipped = 0;   // with a slice that was not encoded
  std::uint64_t sent = 0;
  std::uint64_t complete = 0;  // every slice decoded
  std::uint64_t in_time = 0;   // complete, with each slice within kMaxAge of its last column
  std::uint64_t slices_sent = 0;
  std::uint64_t slices_lost = 0;  // encoded but not decoded
};

class Ledger {
 public:
  /// Takes the records captured, encoded, decoded and posed; ignores others and malformed ones.
  void Add(const nlohmann::json& record);
  void Add(SliceKey key, const Comparison& comparison);

  /// Slices encoded after `settled` may still be under way and do not count as lost. Scans captured
  /// after it do not count as skipped.
  ScanCounts Count(std::int64_t settled = INT64_MAX) const;
  const std::map<std::uint32_t, ScanLife>& scans() const { return scans_; }
  /// Times at which the edge had the pose of each scan.
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
