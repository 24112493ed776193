// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts scans of any sensor to packets of an Ouster sensor, in a capture.
#pragma once
#include <string>
#include <vector>

#include "src/ouster/metadata.h"
#include "src/tools/lab/codec_lab/scan.h"

namespace lidar::tools {

/// "hdl64" (Velodyne HDL-64E, as KITTI drove it) or "N:TOP:BOTTOM", N beams from TOP to BOTTOM
/// degrees above the horizon. Throws std::runtime_error.
std::vector<Beam> ParseBeams(const std::string& text);

/// A sensor whose frame is that of the cloud, with the origin of the beams at its origin. A turn
/// begins at -x, as in Ouster's and KITTI's scans. `columns` is a multiple of 16.
SensorModel ModelOfCloud(const std::vector<Beam>& beams, std::uint32_t columns);

/// Puts a cloud into the pixels of `geometry`, the nearest point in each. An organised scan stays
/// unchanged. A point moves by up to half a pixel across its ray, and not along it.
Scan ToRangeImage(const Scan& scan, const std::shared_ptr<const ScanGeometry>& geometry);

/// Metadata of the capture's sensor: profile RNG19_RFL8_SIG16_NIR16.
ouster::Metadata MetadataOf(const ScanSet& set);

/// Throws std::runtime_error. The scans must be organised and have one geometry.
void WriteCapture(const ScanSet& set, const ouster::Metadata& metadata, const std::string& path);

}  // namespace lidar::tools
