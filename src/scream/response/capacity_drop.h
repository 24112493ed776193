// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension capacity: a link that turns out to carry much less gets no more at once.
#pragma once
#include <optional>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

class CapacityDrop {
 public:
  /// What is sent now, to be held against what the link carries.
  struct Load {
    DataRate target_bitrate;
    DataSize ref_wnd;
    Duration frame_period{0};
    Duration qdelay_target{0};
    Time last_reaction{};  ///< to any sign of congestion
  };

  explicit CapacityDrop(const Parameters& parameters) : p_(parameters) {}

  /// After each report. Returns the window that fills the link, where the link carries much less
  /// than the target; at most once a round trip.
  std::optional<DataSize> Update(Time now, const PathModel& path, const Load& load);

 private:
  /// The measurement is long, and no other explanation of it at hand.
  bool Sure(Time now, const PathModel& path, const Load& load) const;

  const Parameters& p_;
  Time last_drop_{};
};

}  // namespace lidar::scream
