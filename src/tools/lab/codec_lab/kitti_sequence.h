// SPDX-License-Identifier: LGPL-2.1-or-later
// A sequence in the layout of KITTI's odometry benchmark (Geiger et al., 2012), read and written:
//   velodyne/000000.bin, …  x y z reflectance as F32, beam by beam
//   times.txt               seconds, a line per scan: the middle of its sweep
//   phases/000000.bin, …    not KITTI's: an F32 per point, its time in the sweep, 0 to 1.
//                           Without these, as in KITTI's own sequences, scans have no skew.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "src/base/time.h"
#include "src/tools/lab/codec_lab/scan_source.h"

namespace lidar::tools {

/// The scans of `folder`. Throws std::runtime_error with a message for the user.
std::unique_ptr<ScanStream> OpenKittiSequence(const std::string& folder);

/// The times of times.txt, which have to ascend. Throws std::runtime_error.
std::vector<Time> ReadKittiTimes(const std::string& folder);

/// Returns the beam of each point if the cloud lists its points beam by beam, and each beam begins
/// straight ahead and turns once. Returns an empty list for another order.
std::vector<std::uint16_t> FindRings(const std::vector<float>& xyz);

/// The points of a scan, as the files of a sequence hold them.
struct KittiScan {
  std::vector<float> points;  // x y z reflectance
  std::vector<float> phases;  // empty: not known
};
/// Writes scan `number` into a folder, and makes the folders that it needs.
void WriteKittiScan(const std::string& folder, std::size_t number, const KittiScan& scan);

}  // namespace lidar::tools
