// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/plot.h"

#include <cstdarg>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace lidar::tools {

CsvFile::CsvFile(const std::string& path, const std::string& header)
    : header_(header + '\n'), file_(path, OutputFile::Rest::kKeepRows) {}

void CsvFile::Row(const std::string& row) {
  if (file_.is_open()) file_.stream() << std::exchange(header_, {}) << row << '\n';
}

void CsvFile::Close() { file_.Close(); }

void Plot(const std::string& png, const std::string& commands) {
  std::FILE* gnuplot = popen("gnuplot", "w");
  if (gnuplot == nullptr) throw std::runtime_error("cannot start gnuplot");
  const std::string settings =
      "set terminal png size 900,560 font ',11'\nset output '" + png +
      "'\nset datafile separator ','\nset grid lc rgb '#dddddd'\nset border 3\n"
      "set tics nomirror\n";
  std::fputs((settings + commands + "\n").c_str(), gnuplot);
  if (pclose(gnuplot) != 0)
    throw std::runtime_error("gnuplot failed (Debian package gnuplot-nox) and did not write " +
                             png);
}

std::string Format(const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

}  // namespace lidar::tools
