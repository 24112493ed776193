// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/file_names.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace lidar::mcap {
namespace {

namespace fs = std::filesystem;

/// A number in a file name, as %d or %05d.
struct Conversion {
  std::size_t digits = 0;
  std::size_t length = 0;
};
/// Parses the conversion at the beginning of `text`. Returns nothing if it is not of the form %d or
/// %05d.
std::optional<Conversion> ParseConversion(std::string_view text) {
  std::size_t at = 1;  // after the %
  const bool zeros = at < text.size() && text[at] == '0';
  std::size_t digits = 0;
  const auto parsed = std::from_chars(text.data() + at, text.data() + text.size(), digits);
  if (parsed.ec == std::errc()) at = static_cast<std::size_t>(parsed.ptr - text.data());
  const bool padded = parsed.ec == std::errc();
  if (at >= text.size() || text[at] != 'd' || (padded && !zeros) || digits > 20)
    return std::nullopt;
  return Conversion{digits, at + 1};
}

}  // namespace

std::optional<FileNames> FileNames::Parse(const std::string& location, std::string* why) {
  FileNames names;
  std::string* part = &names.before_;
  for (std::size_t i = 0; i < location.size(); ++i) {
    if (location[i] != '%') {
      *part += location[i];
    } else if (i + 1 < location.size() && location[i + 1] == '%') {
      *part += location[i++];
    } else {
      const auto conversion = ParseConversion(std::string_view(location).substr(i));
      if (!conversion || names.is_numbered_) {
        *why = "the file name may have one number, as in rec-%05d.mcap, and no other % than %%";
        return std::nullopt;
      }
      names.is_numbered_ = true;
      names.digits_ = conversion->digits;
      part = &names.after_;
      i += conversion->length - 1;
    }
  }
  if (names.is_numbered_ && names.after_.find('/') != std::string::npos) {
    *why = "the number must be in the name of the file, not of a folder";
    return std::nullopt;
  }
  return names;
}

std::string FileNames::Name(std::uint32_t number) const {
  if (!is_numbered_) return before_;
  std::string digits = std::to_string(number);
  if (digits.size() < digits_) digits.insert(0, digits_ - digits.size(), '0');
  return before_ + digits + after_;
}

std::string FileNames::Folder() const {
  const fs::path folder = fs::path(before_).parent_path();
  return folder.empty() ? "." : folder.string();
}

std::vector<std::pair<std::uint32_t, std::string>> FileNames::Existing(
    std::error_code* failed) const {
  std::vector<std::pair<std::uint32_t, std::string>> files;
  failed->clear();
  if (!is_numbered_) {
    if (fs::exists(before_, *failed)) files.emplace_back(0, before_);
    return files;
  }
  const std::string prefix = fs::path(before_).filename().string();
  for (fs::directory_iterator i(Folder(), *failed), end; !*failed && i != end;
       i.increment(*failed)) {
    const std::string name = i->path().filename().string();
    if (name.size() <= prefix.size() + after_.size() || name.compare(0, prefix.size(), prefix) != 0)
      continue;
    std::uint32_t number = 0;
    const char* first = name.data() + prefix.size();
    const char* last = name.data() + name.size() - after_.size();
    const auto parsed = std::from_chars(first, last, number);
    // Accepts a file only if its whole name is the name that Name() returns for the number.
    if (parsed.ec == std::errc() && parsed.ptr == last &&
        fs::path(Name(number)).filename().string() == name)
      files.emplace_back(number, Name(number));
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace lidar::mcap
