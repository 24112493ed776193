// SPDX-License-Identifier: LGPL-2.1-or-later
// Files that programs read and write. On a full disk, an incomplete file is removed.
#pragma once
#include <fstream>
#include <string>

namespace lidar::tools {

/// A file to which a program writes. If the file cannot be written, throws std::runtime_error with
/// the path and the reason.
class OutputFile {
 public:
  /// What happens to a file that was not written and closed completely. kRemove removes the file.
  /// kKeepRows removes the file only if it is empty. A file that is not a regular file is never
  /// removed.
  enum class Rest { kRemove, kKeepRows };

  /// If `path` is empty, nothing is written.
  explicit OutputFile(std::string path, Rest rest = Rest::kRemove);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  bool is_open() const { return file_.is_open(); }
  std::ostream& stream() { return file_; }
  /// Closes the file. Must be called at the end, because a full disk may be noticed only here.
  void Close();

 private:
  void RemoveRest();

  const std::string path_;
  const Rest rest_;
  std::ofstream file_;
};

/// Returns the whole file. Throws std::runtime_error if it cannot be opened.
std::string ReadFile(const std::string& path);

/// Writes the whole file. If that fails, throws std::runtime_error and leaves no file.
void WriteFile(const std::string& path, const std::string& text);

/// Throws std::runtime_error if the output on stdout or std::cout could not be written completely.
/// These streams keep an error, so one call at the end of the program suffices.
void FinishStandardOutput();

/// Removes an incomplete file. Does nothing if it is not a regular file.
void RemoveFile(const std::string& path);

}  // namespace lidar::tools
