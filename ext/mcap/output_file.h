// SPDX-License-Identifier: LGPL-2.1-or-later
// A file that holds whole pieces only, and is not there before its first.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "src/base/byte_reader.h"

namespace lidar::gst {

class OutputFile {
 public:
  /// What is there already is replaced where the user has named it, and stays where we have.
  enum class Existing { kReplace, kKeep };
  /// The disk is untouched yet. `sync`: each piece is on the disk before Append() returns.
  OutputFile(std::string path, bool sync, Existing existing)
      : path_(std::move(path)), sync_(sync), existing_(existing) {}
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Writes all of `bytes` behind what is there. After a failure the file is as before, and error()
  /// says why; a file that got nothing is taken away.
  bool Append(ByteView bytes);
  /// False where what was written did not reach the disk.
  bool Close();

  const std::string& path() const { return path_; }
  int error() const { return error_; }  // errno
  bool opening_failed() const { return opening_failed_; }

 private:
  bool Open();
  bool WriteAll(ByteView bytes);
  void TakeBack();

  const std::string path_;
  const bool sync_;
  const Existing existing_;
  int fd_ = -1;
  std::uint64_t size_ = 0;
  int error_ = 0;
  bool opening_failed_ = false;
};

}  // namespace lidar::gst
