// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace lidar::mcap {

std::unique_ptr<InputFile> InputFile::Open(const std::string& path, std::string* why,
                                           const std::atomic<bool>* cancelled) {
  // O_NONBLOCK is set because opening a pipe would otherwise wait for a writer.
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) {
    *why = std::generic_category().message(errno);
    return nullptr;
  }
  struct stat status {};
  const bool is_file = fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
  std::unique_ptr<InputFile> file(
      new InputFile(fd, is_file ? static_cast<std::uint64_t>(status.st_size) : 0, cancelled));
  if (is_file) return file;
  *why = "it is not a regular file";
  return nullptr;
}

InputFile::~InputFile() { close(fd_); }

bool InputFile::Read(std::uint64_t offset, std::size_t n, std::uint8_t* to) {
  if (cancelled_ != nullptr && *cancelled_) return false;
  while (n > 0) {
    const ssize_t got = pread(fd_, to, n, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    offset += static_cast<std::uint64_t>(got);
    to += got;
    n -= static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace lidar::mcap
