// SPDX-License-Identifier: LGPL-2.1-or-later
// Starts another program of this project, reads the lines that it prints, and stops it.
#pragma once
#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "src/tools/common/file_descriptor.h"

namespace lidar::tools {

class ChildProcess {
 public:
  struct Config {
    std::vector<std::string> command;
    std::string error_log;     // file for standard error; empty: that of this process
    bool clouds_pipe = false;  // the child gets a second pipe, as descriptor 3
  };

  /// Starts the program. Throws std::runtime_error if that fails. If this process ends, the kernel
  /// terminates the child.
  explicit ChildProcess(const Config& config);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  int output_fd() const { return output_.get(); }
  int clouds_fd() const { return clouds_.get(); }
  /// Passes the complete lines that are available to `handler`. Returns false at the end of the
  /// output.
  bool ReadLines(const std::function<void(const std::string&)>& handler);

  void Signal(int signal) const;
  /// Returns true if the child has ended. Does not wait.
  bool Ended();
  /// Waits until the child has ended. Returns its exit code, or 128 + the signal that ended it.
  int Wait();

 private:
  pid_t pid_ = -1;
  FileDescriptor output_;
  FileDescriptor clouds_;
  std::string partial_;
  int status_ = -1;
};

/// Returns the folder of the running program.
std::string OwnFolder();

}  // namespace lidar::tools
