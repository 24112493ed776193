// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares the lines of a text with a golden file.
#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace lidar::test {

using Lines = std::vector<std::string>;

/// Expects that `lines` are those of the file at `path`. If UPDATE_GOLDEN is set in the
/// environment, writes the file instead.
inline void ExpectGoldenLines(const Lines& lines, const std::string& path) {
  if (std::getenv("UPDATE_GOLDEN") != nullptr) {
    std::ofstream file(path);
    for (const std::string& line : lines) file << line << "\n";
  }
  std::ifstream file(path);
  ASSERT_TRUE(file.is_open()) << path;
  std::size_t n = 0;
  for (std::string line; std::getline(file, line); ++n)
    ASSERT_EQ(n < lines.size() ? lines[n] : "the end", line)
        << path << ":" << n + 1 << ". Where this is meant, UPDATE_GOLDEN=1 writes the file.";
  EXPECT_EQ(lines.size(), n) << path << " is shorter: " << lines[n];
}

/// Returns the text that an ostream makes of `parts`.
template <class... Parts>
std::string Line(const Parts&... parts) {
  std::ostringstream line;
  line.precision(6);
  (line << ... << parts);
  return line.str();
}

}  // namespace lidar::test
