// SPDX-License-Identifier: LGPL-2.1-or-later
// Starts a program of ours, reads its lines, stops it.
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
    std::string error_log;     // where its standard error goes; empty: to ours
    bool clouds_pipe = false;  // gives it a second pipe, as descriptor 3
  };

  /// Throws std::runtime_error. The child dies with this process.
  explicit ChildProcess(const Config& config);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  int output_fd() const { return output_.get(); }
  int clouds_fd() const { return clouds_.get(); }
  /// Passes complete lines to `handler`. Returns false at the end of the output.
  bool ReadLines(const std::function<void(const std::string&)>& handler);

  void Signal(int signal) const;
  /// Returns true once the child has ended; does not wait.
  bool Ended();
  /// Waits. Returns the exit code, or 128 + the signal that ended the child.
  int Wait();

 private:
  pid_t pid_ = -1;
  FileDescriptor output_;
  FileDescriptor clouds_;
  std::string partial_;
  int status_ = -1;
};

/// The folder of the running program.
std::string OwnFolder();

}  // namespace lidar::tools
