// SPDX-License-Identifier: LGPL-2.1-or-later
// Numbers the files of a folder, whatever their names are, because multifilesrc needs numbers.
#pragma once
#include <string>

namespace lidar::demo {

/// Returns the pattern by which multifilesrc finds the links that LinkScans() makes.
std::string ScansPattern(const std::string& output);
/// Makes numbered links in `output` to the scans in `folder`, in the order of their names. Uses
/// only scans that have the same extension (pcd, ply, las or bin) as the first scan. If there is no
/// scan, throws std::runtime_error with a text for the user.
void LinkScans(const std::string& folder, const std::string& output);

}  // namespace lidar::demo
