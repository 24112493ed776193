// SPDX-License-Identifier: LGPL-2.1-or-later
// Raises the limit of open files for tests with thousands of connections.
#pragma once
#include <sys/resource.h>

#include <algorithm>

namespace lidar::test {

/// Raises the limit of open files to `wanted`, because this process has both ends of each
/// connection. Restores the old limit at the end.
class ManyFiles {
 public:
  explicit ManyFiles(rlim_t wanted) {
    getrlimit(RLIMIT_NOFILE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = std::max(limit.rlim_cur, std::min(wanted, limit.rlim_max));
    setrlimit(RLIMIT_NOFILE, &limit);
    granted_ = limit.rlim_cur;
  }
  ~ManyFiles() { setrlimit(RLIMIT_NOFILE, &before_); }
  ManyFiles(const ManyFiles&) = delete;
  ManyFiles& operator=(const ManyFiles&) = delete;
  rlim_t granted() const { return granted_; }

 private:
  rlimit before_{};
  rlim_t granted_ = 0;
};

}  // namespace lidar::test
