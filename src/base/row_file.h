// SPDX-License-Identifier: LGPL-2.1-or-later
// A text file that grows by rows while a stream runs.
#pragma once
#include <fstream>
#include <string>

namespace lidar {

/// Rows that were written stay, whatever happens then; a file without any is taken away.
class RowFile {
 public:
  RowFile() = default;
  /// Truncates the file, or makes it. Numbers are written as in C. Test ok() for success.
  explicit RowFile(const std::string& path);
  ~RowFile() { Close(); }
  RowFile(RowFile&& other) noexcept;
  RowFile& operator=(RowFile&& other) noexcept;

  bool is_open() const { return file_.is_open(); }
  /// False where the file cannot be written, or not any more.
  bool ok() const { return file_.is_open() && file_.good(); }
  std::ostream& stream() { return file_; }
  /// False where something did not fit.
  bool Flush() { return static_cast<bool>(file_.flush()); }
  void Close();

 private:
  std::string path_;
  std::ofstream file_;
};

}  // namespace lidar
