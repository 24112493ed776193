// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions that return the processor time and the memory of other processes.
#pragma once
#include <sys/types.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace lidar::test {

/// Returns the processor time of a process [s], or 0 if the process no longer exists.
inline double CpuOf(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
  std::string word;
  double user = 0;
  double system = 0;
  for (int i = 0; i < 13; ++i) in >> word;
  in >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// Returns the resident memory of a process [MB], or 0 if the process no longer exists.
inline double MegabytesOf(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/statm");
  double pages = 0;
  double resident = 0;
  in >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

}  // namespace lidar::test
