// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace lidar::gst {

OutputFile::~OutputFile() {
  if (fd_ >= 0) close(fd_);
}

bool OutputFile::Open() {
  const int existing = existing_ == Existing::kKeep ? O_EXCL : O_TRUNC;
  fd_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | existing, 0666);
  opening_failed_ = fd_ < 0;
  if (opening_failed_) error_ = errno;
  return !opening_failed_;
}

bool OutputFile::WriteAll(ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(fd_, bytes.data, bytes.size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes = bytes.Sub(static_cast<std::size_t>(n));
  }
  return !sync_ || fdatasync(fd_) == 0;
}

/// Undoes a failed write to a regular file. Cuts the file to its size before the write, or removes
/// it if that size is 0.
void OutputFile::TakeBack() {
  struct stat status {};
  if (fstat(fd_, &status) != 0 || !S_ISREG(status.st_mode)) return;
  if (size_ == 0) {
    unlink(path_.c_str());
    close(fd_);
    fd_ = -1;
  } else if (ftruncate(fd_, static_cast<off_t>(size_)) == 0) {
    lseek(fd_, static_cast<off_t>(size_), SEEK_SET);
  }
}

bool OutputFile::Append(ByteView bytes) {
  if (fd_ < 0 && !Open()) return false;
  if (!WriteAll(bytes)) {
    error_ = errno;
    TakeBack();
    return false;
  }
  size_ += bytes.size;
  return true;
}

bool OutputFile::Close() {
  if (fd_ < 0) return true;
  const bool closed = close(fd_) == 0;
  if (!closed) error_ = errno;
  fd_ = -1;
  return closed;
}

}  // namespace lidar::gst
