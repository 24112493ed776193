// SPDX-License-Identifier: LGPL-2.1-or-later
// The common part of readers of PCD and PLY: lines, fields, numbers as text.
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

/// Reads a header line by line.
class Lines {
 public:
  explicit Lines(ByteView file) : file_(file) {}
  /// The words of the next line; nothing at the end of the header.
  std::optional<std::vector<std::string_view>> Next();
  /// The bytes after the last line that was read.
  ByteView Rest() const { return file_.Sub(position_); }
  /// Text of the last line that was read.
  std::string_view text() const { return text_; }

 private:
  ByteView file_;
  std::size_t position_ = 0;
  std::string_view text_;
};

std::optional<std::uint64_t> ParseCount(std::string_view text);
/// The time [ns since 1970] in a comment of our own writers.
std::optional<std::uint64_t> ParseCaptureTime(std::string_view comment);

/// A field of a point, in the file's order.
struct FileField {
  std::string name;  // empty: padding
  std::optional<FieldType> type;
  std::uint32_t size = 0;   // bytes of one number
  std::uint32_t count = 1;  // numbers
};

/// Sets fields and point_step of `cloud`. Returns false if there are too many fields, or none.
bool Lay(const std::vector<FileField>& fields, FileCloud* cloud, std::string* why);
/// Bytes of all points; nothing if that is beyond kMaxCloud.
std::optional<std::size_t> SizeOfPoints(const FileCloud& cloud, std::string* why);

/// Reads the numbers of all points from text into little-endian points. Returns false if some are
/// missing or malformed.
bool ReadText(ByteView text, const std::vector<FileField>& fields, FileCloud* cloud,
              std::string* why);

}  // namespace lidar::cloud_file
