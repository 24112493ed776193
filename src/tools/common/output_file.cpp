// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/common/output_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace lidar::tools {
namespace {

[[noreturn]] void ThrowCannotWrite(const std::string& path, int reason) {
  throw std::runtime_error("cannot write " + path +
                           (reason != 0 ? std::string(": ") + std::strerror(reason) : ""));
}

}  // namespace

void RemoveFile(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) std::filesystem::remove(path, ignored);
}

void FinishStandardOutput() {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (!flushed || std::ferror(stdout) != 0 || !std::cout.flush())
    ThrowCannotWrite("to the standard output", errno);
}

OutputFile::OutputFile(std::string path, Rest rest) : path_(std::move(path)), rest_(rest) {
  if (path_.empty()) return;
  errno = 0;
  file_.open(path_);
  if (!file_) ThrowCannotWrite(path_, errno);
}

OutputFile::~OutputFile() {
  if (!file_.is_open()) return;
  file_.close();
  RemoveRest();
}

void OutputFile::RemoveRest() {
  std::error_code error;
  if (rest_ == Rest::kRemove || std::filesystem::file_size(path_, error) == 0) RemoveFile(path_);
}

void OutputFile::Close() {
  if (!file_.is_open()) return;
  errno = 0;
  const bool was_good = file_.good();
  file_.close();
  if (was_good && file_) return;
  const int reason = errno;
  RemoveRest();
  ThrowCannotWrite(path_, reason);
}

std::string ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot open " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

void WriteFile(const std::string& path, const std::string& text) {
  OutputFile file(path);
  file.stream() << text;
  file.Close();
}

}  // namespace lidar::tools
