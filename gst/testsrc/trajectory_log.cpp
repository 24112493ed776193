// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/testsrc/trajectory_log.h"

#include <iomanip>

namespace lidar::gst {

TrajectoryLog::TrajectoryLog(const std::string& path) : file_(path) {
  file_.stream() << std::fixed << "# timestamp tx ty tz qx qy qz qw\n" << std::flush;
}

bool TrajectoryLog::Write(GstClockTime capture_time, const synth::Pose& pose) {
  const auto [x, y, z, w] = pose.ToQuaternion();
  // A double does not hold the nanoseconds of a Unix time.
  file_.stream() << capture_time / GST_SECOND << '.' << std::setfill('0') << std::setw(9)
                 << capture_time % GST_SECOND << std::setprecision(6) << ' ' << pose.x << ' '
                 << pose.y << ' ' << pose.z << std::setprecision(9) << ' ' << x << ' ' << y << ' '
                 << z << ' ' << w << '\n';
  return file_.Flush();
}

}  // namespace lidar::gst
