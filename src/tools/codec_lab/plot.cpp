// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/codec_lab/plot.h"

#include <cstdarg>
#include <cstdio>
#include <stdexcept>

namespace lidar::tools {

CsvFile::CsvFile(const std::string& path, const std::string& header) : path_(path) {
  if (path.empty()) return;
  file_.open(path);
  if (!file_) throw std::runtime_error("cannot write " + path);
  Row(header);
}

void CsvFile::Row(const std::string& row) {
  if (!path_.empty()) file_ << row << '\n';
}

void CsvFile::Close() {
  if (!path_.empty() && !file_.flush()) throw std::runtime_error("cannot write " + path_);
}

void Plot(const std::string& png, const std::string& commands) {
  std::FILE* gnuplot = popen("gnuplot", "w");
  if (gnuplot == nullptr) throw std::runtime_error("cannot start gnuplot");
  const std::string settings =
      "set terminal png size 900,560 font ',11'\nset output '" + png +
      "'\nset datafile separator ','\nset grid lc rgb '#dddddd'\nset border 3\n"
      "set tics nomirror\n";
  std::fputs((settings + commands + "\n").c_str(), gnuplot);
  if (pclose(gnuplot) != 0)
    throw std::runtime_error("gnuplot failed (Debian package gnuplot-nox), no plot " + png);
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
