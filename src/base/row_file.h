// SPDX-License-Identifier: LGPL-2.1-or-later
// A text file that grows by rows while a stream runs.
#pragma once
#include <fstream>
#include <string>

namespace lidar {

/// Written rows stay after a failure; a file without rows is removed.
class RowFile {
 public:
  RowFile() = default;
  /// Truncates or creates the file; ok() shows whether that worked. Numbers have the C locale.
  explicit RowFile(const std::string& path);
  ~RowFile() { Close(); }
  RowFile(RowFile&& other) noexcept;
  RowFile& operator=(RowFile&& other) noexcept;

  bool is_open() const { return file_.is_open(); }
  /// Returns false if a write failed.
  bool ok() const { return file_.is_open() && file_.good(); }
  std::ostream& stream() { return file_; }
  /// Returns false if some rows could not be written.
  bool Flush() { return static_cast<bool>(file_.flush()); }
  void Close();

 private:
  std::string path_;
  std::ofstream file_;
};

}  // namespace lidar
