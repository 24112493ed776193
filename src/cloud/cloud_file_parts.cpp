// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/cloud_file_parts.h"

#include <algorithm>
#include <charconv>

#include "src/cloud/field_number.h"

namespace lidar::cloud_file {
namespace {

constexpr std::string_view kCaptureTime = "capture time [s since 1970-01-01T00:00:00Z]: ";
constexpr std::uint64_t kSecond = 1'000'000'000;

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Removes the next word from `text` and returns it. Returns an empty word if there is none.
std::string_view TakeWord(std::string_view* text) {
  while (!text->empty() && IsSpace(text->front())) text->remove_prefix(1);
  std::size_t n = 0;
  while (n < text->size() && !IsSpace((*text)[n])) ++n;
  const std::string_view word = text->substr(0, n);
  text->remove_prefix(n);
  return word;
}

/// Returns the beginning of `word` for use in a message, which must be valid UTF-8.
std::string Quoted(std::string_view word) {
  std::string text(word.substr(0, 20));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return '"' + text + '"';
}

std::string_view View(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data), bytes.size};
}

}  // namespace

std::optional<std::vector<std::string_view>> Lines::Next() {
  const std::string_view left = View(file_.Sub(position_, kMaxHeader - position_));
  const std::size_t end = left.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  text_ = left.substr(0, end);
  position_ += end + 1;
  std::vector<std::string_view> words;
  std::string_view line = text_;
  for (std::string_view word = TakeWord(&line); !word.empty(); word = TakeWord(&line))
    words.push_back(word);
  return words;
}

std::optional<std::uint64_t> ParseCount(std::string_view text) {
  std::uint64_t count = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), count);
  if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return std::nullopt;
  return count;
}

std::optional<std::uint64_t> ParseCaptureTime(std::string_view comment) {
  const std::size_t at = comment.find(kCaptureTime);
  if (at == std::string_view::npos) return std::nullopt;
  std::string_view time = comment.substr(at + kCaptureTime.size());
  while (!time.empty() && IsSpace(time.back())) time.remove_suffix(1);
  const std::size_t point = time.find('.');
  if (point == std::string_view::npos || time.size() - point != 10) return std::nullopt;
  const auto seconds = ParseCount(time.substr(0, point));
  const auto nanoseconds = ParseCount(time.substr(point + 1));
  if (!seconds || !nanoseconds || *seconds > INT64_MAX / kSecond) return std::nullopt;
  return *seconds * kSecond + *nanoseconds;
}

bool Lay(const std::vector<FileField>& fields, FileCloud* cloud, std::string* why) {
  std::uint64_t offset = 0;
  for (const FileField& f : fields) {
    const std::uint64_t size = std::uint64_t{f.size} * f.count;
    const bool usable = f.type && !f.name.empty() && f.count <= PointFields::kMaxFields;
    for (std::uint32_t i = 0; usable && i < f.count; ++i) {
      std::string name = f.count == 1 ? f.name : f.name + "[" + std::to_string(i) + "]";
      const bool known = std::any_of(cloud->fields.begin(), cloud->fields.end(),
                                     [&](const PointField& other) { return other.name == name; });
      if (!known)
        cloud->fields.push_back(
            {std::move(name), *f.type, static_cast<std::uint32_t>(offset + i * f.size)});
    }
    offset += size;
    if (offset > kMaxHeader || cloud->fields.size() > PointFields::kMaxFields) {
      *why = "a point has too many fields";
      return false;
    }
  }
  cloud->point_step = static_cast<std::uint32_t>(offset);
  if (cloud->fields.empty()) *why = "there are no fields";
  return !cloud->fields.empty();
}

std::optional<std::size_t> SizeOfPoints(const FileCloud& cloud, std::string* why) {
  const std::uint64_t points = std::uint64_t{cloud.width} * cloud.height;
  if (points <= kMaxCloud / cloud.point_step) return points * cloud.point_step;
  *why = "the cloud is larger than 1 GiB";
  return std::nullopt;
}

bool ReadText(ByteView text, const std::vector<FileField>& fields, FileCloud* cloud,
              std::string* why) {
  const auto size = SizeOfPoints(*cloud, why);
  if (!size) return false;
  std::uint64_t numbers = 0;
  for (const FileField& f : fields) numbers += f.count;
  const std::uint64_t points = std::uint64_t{cloud->width} * cloud->height;
  *why = "the file ends before its last point";
  // A number needs at least two bytes: a digit and a space.
  if (points * numbers > text.size / 2 + 1) return false;
  cloud->points.resize(*size);
  std::string_view left = View(text);
  std::uint8_t* to = cloud->points.data();
  for (std::uint64_t i = 0; i < points; ++i) {
    for (const FileField& f : fields) {
      for (std::uint32_t k = 0; k < f.count; ++k, to += f.size) {
        std::string_view word = TakeWord(&left);
        if (word.empty()) return false;
        if (word.front() == '+') word.remove_prefix(1);
        double value = 0;
        const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
        if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size()) {
          *why = Quoted(word) + " is not a number";
          return false;
        }
        if (f.type) WriteNumber(value, *f.type, to);
      }
    }
  }
  return true;
}

}  // namespace lidar::cloud_file
