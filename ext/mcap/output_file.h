// SPDX-License-Identifier: LGPL-2.1-or-later
// A file that is written in whole pieces, and created with the first one.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "src/base/byte_reader.h"

namespace lidar::gst {

class OutputFile {
 public:
  /// A file that the user has named is replaced; a numbered one stays.
  enum class Existing { kReplace, kKeep };
  /// Does not touch the disk yet. `sync`: each piece is on the disk before Append() returns.
  OutputFile(std::string path, bool sync, Existing existing)
      : path_(std::move(path)), sync_(sync), existing_(existing) {}
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends all of `bytes`. After a failure the file is as before, or removed if it was empty, and
  /// error() has the reason.
  bool Append(ByteView bytes);
  /// Returns false if what was written did not reach the disk.
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
