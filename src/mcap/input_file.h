// SPDX-License-Identifier: LGPL-2.1-or-later
// A file to be read anywhere.
#pragma once
#include <memory>
#include <string>

#include "src/mcap/record_input.h"

namespace lidar::mcap {

class InputFile : public Input {
 public:
  /// None where it cannot be opened or is no file; `why` then says so.
  static std::unique_ptr<InputFile> Open(const std::string& path, std::string* why);
  ~InputFile() override;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// When it was opened.
  std::uint64_t size() const override { return size_; }
  bool Read(std::uint64_t offset, std::size_t n, std::uint8_t* to) override;

 private:
  InputFile(int fd, std::uint64_t size) : fd_(fd), size_(size) {}

  const int fd_;
  const std::uint64_t size_;
};

}  // namespace lidar::mcap
