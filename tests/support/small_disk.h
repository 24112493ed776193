// SPDX-License-Identifier: LGPL-2.1-or-later
// Simulates a disk that is full.
#pragma once
#include <sys/resource.h>

#include <csignal>

namespace lidar::test {

/// Limits the size of files to `size` bytes while this object exists. A write beyond the limit
/// fails, as it does on a full disk.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t size) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{size, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit before_{};
};

}  // namespace lidar::test
