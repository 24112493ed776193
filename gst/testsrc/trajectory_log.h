// SPDX-License-Identifier: LGPL-2.1-or-later
// Poses as a text file in the format of the TUM RGB-D benchmark, which evo and others read.
#pragma once
#include <gst/gst.h>

#include <fstream>
#include <string>

#include "src/synth/geometry.h"

namespace lidar::gst {

class TrajectoryLog {
 public:
  /// Truncates the file. Test ok() for success.
  explicit TrajectoryLog(const std::string& path);
  bool ok() const { return file_.good(); }
  /// Appends "seconds x y z qx qy qz qw" for the time `capture_time` [ns since the Unix epoch].
  void Write(GstClockTime capture_time, const synth::Pose& pose);

 private:
  std::ofstream file_;
};

}  // namespace lidar::gst
