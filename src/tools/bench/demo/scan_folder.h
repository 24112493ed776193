// SPDX-License-Identifier: LGPL-2.1-or-later
// A folder of scans under any names, as multifilesrc wants them: numbered.
#pragma once
#include <string>

namespace lidar::demo {

/// Where LinkScans() puts its links, as multifilesrc names them.
std::string ScansPattern(const std::string& output);
/// Links the files of `folder`, in the order of their names, under numbers into the folder
/// `output`: those with the extension (pcd, ply, las or bin) of the first. Throws
/// std::runtime_error with a text for the user where there is none.
void LinkScans(const std::string& folder, const std::string& output);

}  // namespace lidar::demo
