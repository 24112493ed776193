// SPDX-License-Identifier: LGPL-2.1-or-later
// The names of the files of a recording: a single name, or numbered names.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace lidar::mcap {

class FileNames {
 public:
  /// Parses `location`, a path whose file name may contain a number: `rec-%05d.mcap`. Returns
  /// nothing and sets `why`, a text for users, if there is another conversion or a second number.
  static std::optional<FileNames> Parse(const std::string& location, std::string* why);

  bool is_numbered() const { return is_numbered_; }
  std::string Name(std::uint32_t number) const;
  /// Returns the folder of the files.
  std::string Folder() const;
  /// Returns the existing files, sorted by number. If the names have no number, returns the only
  /// file, if it exists. Sets `failed` if the folder cannot be read.
  std::vector<std::pair<std::uint32_t, std::string>> Existing(std::error_code* failed) const;

 private:
  std::string before_;  // the parts of the path before and after the number
  std::string after_;
  std::size_t digits_ = 0;
  bool is_numbered_ = false;
};

}  // namespace lidar::mcap
