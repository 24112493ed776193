// SPDX-License-Identifier: LGPL-2.1-or-later
// A text file to which rows are added while a stream runs.
#pragma once
#include <fstream>
#include <string>

namespace lidar {

/// A file of rows. If a write fails, the rows before it are kept. A file without rows is removed.
class RowFile {
 public:
  RowFile() = default;
  /// Creates or truncates the file. If that fails, ok() returns false. Numbers are written in the C
  /// locale.
  explicit RowFile(const std::string& path);
  ~RowFile() { Close(); }
  RowFile(RowFile&& other) noexcept;
  RowFile& operator=(RowFile&& other) noexcept;

  bool is_open() const { return file_.is_open(); }
  /// Returns false if the file is not open or if a write failed.
  bool ok() const { return file_.is_open() && file_.good(); }
  std::ostream& stream() { return file_; }
  /// Writes buffered rows to the file. Returns false if some rows could not be written.
  bool Flush() { return static_cast<bool>(file_.flush()); }
  void Close();

 private:
  std::string path_;
  std::ofstream file_;
};

}  // namespace lidar
