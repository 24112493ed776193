// SPDX-License-Identifier: LGPL-2.1-or-later
// Files that programs read and write, and their remains on a full disk.
#pragma once
#include <fstream>
#include <string>

namespace lidar::tools {

/// Throws std::runtime_error, with the path and the reason, if the file cannot be written.
class OutputFile {
 public:
  /// What becomes of a file that was not written or closed completely: it is removed, or keeps its
  /// rows if it has any. Files that are not regular are never removed.
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

/// Returns the whole file. Throws std::runtime_error if it cannot be opened.
std::string ReadFile(const std::string& path);

/// Writes the whole file, or leaves no file.
void WriteFile(const std::string& path, const std::string& text);

/// Throws if printed output could not be written. The stream keeps such errors, so one call at the
/// end suffices.
void FinishStandardOutput();

/// Removes an incomplete file, if it is a regular one.
void RemoveFile(const std::string& path);

}  // namespace lidar::tools
