// SPDX-License-Identifier: LGPL-2.1-or-later
// A folder of scans under any names, numbered for multifilesrc.
#pragma once
#include <string>

namespace lidar::demo {

/// The pattern of LinkScans()'s links for multifilesrc.
std::string ScansPattern(const std::string& output);
/// Creates numbered links to the files of `folder`, in the order of their names, in `output`.
/// Takes only files with the extension (pcd, ply, las or bin) of the first. Throws
/// std::runtime_error with a text for the user if there is no file.
void LinkScans(const std::string& folder, const std::string& output);

}  // namespace lidar::demo
