// SPDX-License-Identifier: LGPL-2.1-or-later
// The names of a recording's files: a single name, or numbered ones.
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
  /// `location` is a path; its file name may have a number: `rec-%05d.mcap`. Returns nothing for
  /// another conversion, or a second one; `why` then has the reason for a user.
  static std::optional<FileNames> Parse(const std::string& location, std::string* why);

  bool is_numbered() const { return is_numbered_; }
  std::string Name(std::uint32_t number) const;
  /// The folder that the files are in.
  std::string Folder() const;
  /// The existing files by number, or the only file. Sets `failed` if the folder cannot be read.
  std::vector<std::pair<std::uint32_t, std::string>> Existing(std::error_code* failed) const;

 private:
  std::string before_;  // the parts before and after the number
  std::string after_;
  std::size_t digits_ = 0;
  bool is_numbered_ = false;
};

}  // namespace lidar::mcap
