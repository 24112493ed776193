// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads and writes a sequence in the layout of KITTI's odometry benchmark (Geiger et al., 2012):
//   velodyne/000000.bin, …  x y z reflectance as F32, beam by beam
//   times.txt               the middle of each scan's sweep [s], one line per scan
//   phases/000000.bin, …    time of each point in the sweep as F32, from 0 to 1. KITTI's own
//                           sequences do not have these files. Their scans have no skew.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "src/base/time.h"
#include "src/tools/lab/codec_lab/scan_source.h"

namespace lidar::tools {

/// Opens the sequence in `folder`. Throws std::runtime_error with a message for the user.
std::unique_ptr<ScanStream> OpenKittiSequence(const std::string& folder);

/// Reads the times in times.txt. Throws std::runtime_error if they do not ascend or cannot be read.
std::vector<Time> ReadKittiTimes(const std::string& folder);

/// Returns the beam of each point. The cloud must list its points beam by beam, and each beam must
/// begin straight ahead and make one turn. Returns an empty list for any other order.
std::vector<std::uint16_t> FindRings(const std::vector<float>& xyz);

/// The points of a scan in the form in which the files of a sequence contain them.
struct KittiScan {
  std::vector<float> points;  // x y z reflectance
  std::vector<float> phases;  // empty if they are not known
};
/// Writes the scan `number` to `folder`. Makes the folders that are missing.
void WriteKittiScan(const std::string& folder, std::size_t number, const KittiScan& scan);

}  // namespace lidar::tools
