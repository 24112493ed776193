// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/base/row_file.h"

#include <filesystem>
#include <locale>
#include <utility>

namespace lidar {

RowFile::RowFile(const std::string& path) : path_(path), file_(path, std::ios::trunc) {
  file_.imbue(std::locale::classic());
}

RowFile::RowFile(RowFile&& other) noexcept
    : path_(std::move(other.path_)), file_(std::move(other.file_)) {}

RowFile& RowFile::operator=(RowFile&& other) noexcept {
  if (this == &other) return *this;
  Close();
  path_ = std::move(other.path_);
  file_ = std::move(other.file_);
  return *this;
}

/// Removes the file if it is empty. It must be a regular file, because a device such as /dev/full
/// must not be removed.
void RowFile::Close() {
  if (!file_.is_open()) return;
  file_.close();
  std::error_code error;
  if (std::filesystem::is_regular_file(path_, error) &&
      std::filesystem::file_size(path_, error) == 0 && !error) {
    std::filesystem::remove(path_, error);
  }
}

}  // namespace lidar
