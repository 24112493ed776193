// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension capacity: reduces the rate at once when the link carries much less.
#pragma once
#include <optional>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

class CapacityDrop {
 public:
  /// The present sending rate, compared with the link's capacity.
  struct Load {
    DataRate target_bitrate;
    DataSize ref_wnd;
    Duration frame_period{0};
    Duration qdelay_target{0};
    Time last_reaction{};  ///< to any sign of congestion
  };

  explicit CapacityDrop(const Parameters& parameters) : p_(parameters) {}

  /// Call it after each report. Returns the window that fills the link if it carries much less than
  /// the target, at most once a round trip.
  std::optional<DataSize> Update(Time now, const PathModel& path, const Load& load);

 private:
  /// Returns true if the measurement is long enough and has no other explanation.
  bool Sure(Time now, const PathModel& path, const Load& load) const;

  const Parameters& p_;
  Time last_drop_{};
};

}  // namespace lidar::scream
