// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts scans of any sensor to packets of an Ouster sensor, and writes them to a capture.
#pragma once
#include <string>
#include <vector>

#include "src/ouster/metadata.h"
#include "src/tools/lab/codec_lab/scan.h"

namespace lidar::tools {

/// Parses "hdl64" (the Velodyne HDL-64E that KITTI used) or "N:TOP:BOTTOM". The latter means N
/// beams from TOP to BOTTOM, in degrees above the horizon. Throws std::runtime_error for other
/// text.
std::vector<Beam> ParseBeams(const std::string& text);

/// Returns a sensor whose frame is that of the cloud, and whose beams start at the origin. A turn
/// begins at -x, as in the scans of Ouster and of KITTI. `columns` must be a multiple of 16.
SensorModel ModelOfCloud(const std::vector<Beam>& beams, std::uint32_t columns);

/// Puts the points of a cloud into the pixels of `geometry`. A pixel gets the nearest of its
/// points. A point moves by up to half a pixel across its ray, but not along it. Returns an
/// organised scan unchanged.
Scan ToRangeImage(const Scan& scan, const std::shared_ptr<const ScanGeometry>& geometry);

/// Returns the metadata of the sensor in the capture. Its profile is RNG19_RFL8_SIG16_NIR16.
ouster::Metadata MetadataOf(const ScanSet& set);

/// Writes the scans to a capture. They must be organised and have the same geometry. Throws
/// std::runtime_error if the capture cannot be written.
void WriteCapture(const ScanSet& set, const ouster::Metadata& metadata, const std::string& path);

}  // namespace lidar::tools
