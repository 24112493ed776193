// SPDX-License-Identifier: LGPL-2.1-or-later
// A file that is written in whole pieces. It is created when the first piece is written.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "src/base/byte_reader.h"

namespace lidar::gst {

class OutputFile {
 public:
  /// Says what to do if the file exists. A file that the user has named is replaced. A numbered
  /// file is kept, and opening it fails.
  enum class Existing { kReplace, kKeep };
  /// Does not access the disk. If `sync` is true, Append() returns after the piece is on the disk.
  OutputFile(std::string path, bool sync, Existing existing)
      : path_(std::move(path)), sync_(sync), existing_(existing) {}
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends all of `bytes`. If that fails, sets error() and returns false. The file is then as it
  /// was before, or removed if it was empty.
  bool Append(ByteView bytes);
  /// Closes the file. Returns false if written data did not reach the disk.
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
