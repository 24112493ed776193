// SPDX-License-Identifier: LGPL-2.1-or-later
// The greatest number of bytes in flight (max_bytes_in_flight) in the current round trip, in the
// previous one, and in the last few.
#pragma once
#include <algorithm>
#include <deque>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {

class MaxBytesInFlight {
 public:
  void Add(DataSize bytes_in_flight) { current_ = std::max(current_, bytes_in_flight); }
  void Update(Time now, Duration round_trip) {
    if (now - start_ < round_trip) return;
    start_ = now;
    history_.push_front(current_);
    if (history_.size() > kHistory) history_.pop_back();
    current_ = DataSize();
  }
  DataSize current() const { return current_; }
  DataSize previous() const { return history_.empty() ? DataSize() : history_.front(); }
  /// Returns the greatest value in the current and the previous round trip.
  DataSize lately() const { return std::max(current_, previous()); }
  DataSize longest() const {
    DataSize max = current_;
    for (const DataSize s : history_) max = std::max(max, s);
    return max;
  }

 private:
  static constexpr std::size_t kHistory = 10;
  Time start_{};
  DataSize current_;
  std::deque<DataSize> history_;
};

}  // namespace lidar::scream
