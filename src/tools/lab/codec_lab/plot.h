// SPDX-License-Identifier: LGPL-2.1-or-later
// CSV files and the plots of them, drawn by gnuplot.
#pragma once
#include <string>

#include "src/tools/common/output_file.h"

namespace lidar::tools {

/// Throws std::runtime_error if the file cannot be written.
class CsvFile {
 public:
  /// An empty path writes nothing.
  CsvFile(const std::string& path, const std::string& header);
  void Row(const std::string& row);
  /// Call it at the end: a full disk shows up here.
  void Close();

 private:
  std::string header_;  // empty once it was written with the first row
  OutputFile file_;
};

/// Runs `commands` after the settings for a PNG at `png`. Throws if gnuplot is missing or fails.
void Plot(const std::string& png, const std::string& commands);

/// printf into a string.
std::string Format(const char* format, ...) __attribute__((format(printf, 1, 2)));

}  // namespace lidar::tools
