// SPDX-License-Identifier: LGPL-2.1-or-later
// Files that programs read and write, and their rest on a full disk.
#pragma once
#include <fstream>
#include <string>

namespace lidar::tools {

/// Throws std::runtime_error, with the path and the reason, where the file cannot be written.
class OutputFile {
 public:
  /// Rest of a file that cannot be written whole, or is not closed. An empty file never stays; only
  /// regular files are removed.
  enum class Rest { kRemove, kKeepRows };

  /// An empty path writes nothing.
  explicit OutputFile(std::string path, Rest rest = Rest::kRemove);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  bool is_open() const { return file_.is_open(); }
  std::ostream& stream() { return file_; }
  /// Call this at the end: a full disk shows up here.
  void Close();

 private:
  void RemoveRest();

  const std::string path_;
  const Rest rest_;
  std::ofstream file_;
};

/// All of the file. Throws std::runtime_error if it cannot be opened.
std::string ReadFile(const std::string& path);

/// Writes all of the file, or no file.
void WriteFile(const std::string& path, const std::string& text);

/// Throws if something that was printed could not be written. Errors of a full disk stay with the
/// stream, so it is enough to ask once, at the end.
void FinishStandardOutput();

/// Removes an incomplete file, if it is a regular one.
void RemoveFile(const std::string& path);

}  // namespace lidar::tools
