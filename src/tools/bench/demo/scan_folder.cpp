// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/scan_folder.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace lidar::demo {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLinks = "scan-links";

bool IsScan(const fs::directory_entry& file) {
  const std::string extension = file.path().extension();
  return file.is_regular_file() &&
         (extension == ".pcd" || extension == ".ply" || extension == ".las" || extension == ".bin");
}

std::vector<fs::path> ScansIn(const std::string& folder) {
  std::vector<fs::path> scans;
  for (const auto& file : fs::directory_iterator(folder))
    if (IsScan(file)) scans.push_back(fs::absolute(file.path()));
  std::sort(scans.begin(), scans.end());
  if (scans.empty()) throw std::runtime_error("no .pcd, .ply, .las or .bin in " + folder);
  const auto other = [first = scans.front().extension()](const fs::path& path) {
    return path.extension() != first;
  };
  scans.erase(std::remove_if(scans.begin(), scans.end(), other), scans.end());
  return scans;
}

/// Removes the symbolic links of an earlier run, but no other files.
void RemoveLinks(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_symlink()) fs::remove(entry.path());
}

}  // namespace

std::string ScansPattern(const std::string& output) {
  return (fs::path(output) / kLinks / "%06d").string();
}

void LinkScans(const std::string& folder, const std::string& output) {
  const auto scans = ScansIn(folder);
  const fs::path links = fs::path(output) / kLinks;
  fs::create_directories(links);
  RemoveLinks(links);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    char number[24];
    std::snprintf(number, sizeof number, "%06zu", i);
    fs::create_symlink(scans[i], links / number);
  }
}

}  // namespace lidar::demo
