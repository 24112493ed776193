// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions to read files in tests, and temporary folders.
#pragma once
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace lidar::test {

/// Returns the bytes of a file, or an empty text if the file cannot be read.
inline std::string ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the number of file descriptors that this process has open.
inline std::ptrdiff_t OpenFiles() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

/// Creates a temporary folder, and removes it when this object is destroyed.
class TempFolder {
 public:
  TempFolder() : path_(std::filesystem::temp_directory_path() / "lidar-test-XXXXXX") {
    if (mkdtemp(path_.data()) == nullptr) ADD_FAILURE() << "no folder " << path_;
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A test fixture with a temporary folder.
class FolderTest : public ::testing::Test {
 private:
  const TempFolder owner_;

 protected:
  const std::string& folder_ = owner_.path();
};

}  // namespace lidar::test
