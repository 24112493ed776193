// SPDX-License-Identifier: LGPL-2.1-or-later
// The common parts of the PCD and PLY readers: header lines, fields, and numbers in text form.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/cloud/cloud_files.h"

namespace lidar::cloud_file {

constexpr std::size_t kMaxHeader = 65'536;               // bytes
constexpr std::size_t kMaxCloud = std::size_t{1} << 30;  // bytes

/// Reads the header of a file line by line.
class Lines {
 public:
  explicit Lines(ByteView file) : file_(file) {}
  /// Returns the words of the next line, or nothing at the end of the header.
  std::optional<std::vector<std::string_view>> Next();
  /// Returns the bytes after the line that was read last.
  ByteView Rest() const { return file_.Sub(position_); }
  /// Returns the text of the line that was read last.
  std::string_view text() const { return text_; }

 private:
  ByteView file_;
  std::size_t position_ = 0;
  std::string_view text_;
};

std::optional<std::uint64_t> ParseCount(std::string_view text);
/// Returns the capture time [ns since 1970] from a comment that our own file encoders write.
std::optional<std::uint64_t> ParseCaptureTime(std::string_view comment);

/// A field of a point. Fields are in the order of the file.
struct FileField {
  std::string name;  // empty for padding
  std::optional<FieldType> type;
  std::uint32_t size = 0;   // size of a number [bytes]
  std::uint32_t count = 1;  // count of numbers in the field
};

/// Sets `fields` and `point_step` of the cloud. Returns false if there are no fields, or too many.
bool Lay(const std::vector<FileField>& fields, FileCloud* cloud, std::string* why);
/// Returns the size of all points in bytes, or nothing if it exceeds kMaxCloud.
std::optional<std::size_t> SizeOfPoints(const FileCloud& cloud, std::string* why);

/// Reads the numbers of all points from text, and stores them as little-endian points. Returns
/// false if a number is missing or malformed.
bool ReadText(ByteView text, const std::vector<FileField>& fields, FileCloud* cloud,
              std::string* why);

}  // namespace lidar::cloud_file
