// SPDX-License-Identifier: LGPL-2.1-or-later
// A file with random access.
#pragma once
#include <atomic>
#include <memory>
#include <string>

#include "src/mcap/record_input.h"

namespace lidar::mcap {

class InputFile : public Input {
 public:
  /// Opens a file. Returns null and sets `why` if `path` cannot be opened or is not a regular file.
  /// Reads fail as soon as `cancelled` is true. `cancelled` must outlive the file.
  static std::unique_ptr<InputFile> Open(const std::string& path, std::string* why,
                                         const std::atomic<bool>* cancelled = nullptr);
  ~InputFile() override;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Returns the size that the file had when it was opened.
  std::uint64_t size() const override { return size_; }
  bool Read(std::uint64_t offset, std::size_t n, std::uint8_t* to) override;

 private:
  InputFile(int fd, std::uint64_t size, const std::atomic<bool>* cancelled)
      : fd_(fd), size_(size), cancelled_(cancelled) {}

  const int fd_;
  const std::uint64_t size_;
  const std::atomic<bool>* const cancelled_;
};

}  // namespace lidar::mcap
