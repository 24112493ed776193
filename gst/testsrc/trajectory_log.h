// SPDX-License-Identifier: LGPL-2.1-or-later
// Poses as a text file in the format of the TUM RGB-D benchmark, which evo and others read.
#pragma once
#include <gst/gst.h>

#include <string>

#include "src/base/row_file.h"
#include "src/synth/geometry.h"

namespace lidar::gst {

class TrajectoryLog {
 public:
  /// Truncates the file. Test ok() for success.
  explicit TrajectoryLog(const std::string& path);
  bool ok() const { return file_.ok(); }
  /// Appends "seconds x y z qx qy qz qw" for the time `capture_time` [ns since the Unix epoch].
  /// False where that did not fit.
  bool Write(GstClockTime capture_time, const synth::Pose& pose);

 private:
  RowFile file_;
};

}  // namespace lidar::gst
