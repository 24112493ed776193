// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes CSV files, and draws plots with gnuplot.
#pragma once
#include <string>

#include "src/tools/common/output_file.h"

namespace lidar::tools {

/// A CSV file to which a program writes. Throws std::runtime_error if the file cannot be written.
class CsvFile {
 public:
  /// If `path` is empty, nothing is written.
  CsvFile(const std::string& path, const std::string& header);
  void Row(const std::string& row);
  /// Closes the file. Must be called at the end, because a full disk may be noticed only here.
  void Close();

 private:
  std::string header_;  // empty after it was written with the first row
  OutputFile file_;
};

/// Runs gnuplot with `commands`, after settings for the PNG file `png`. Throws std::runtime_error
/// if gnuplot is missing or fails.
void Plot(const std::string& png, const std::string& commands);

/// Formats text as printf does, and returns it.
std::string Format(const char* format, ...) __attribute__((format(printf, 1, 2)));

}  // namespace lidar::tools
