// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cdr/ros_graph.h"

#include <algorithm>

#include "src/cdr/cdr_writer.h"

namespace lidar::cdr {
namespace {

constexpr std::size_t kMaxName = 255;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsWordCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || IsDigit(c) || c == '_';
}

/// Returns true if `text` consists of words with a single slash between them. A word must not begin
/// with a digit, and `text` must not begin or end with a slash.
bool IsPath(std::string_view text) {
  if (text.empty() || text.size() > kMaxName || text.back() == '/') return false;
  char before = '/';
  for (const char c : text) {
    const bool begins_word = before == '/';
    if (c == '/' ? begins_word : !IsWordCharacter(c) || (begins_word && IsDigit(c))) return false;
    before = c;
  }
  return true;
}

std::string_view WithoutSlash(std::string_view text) {
  if (!text.empty() && text.front() == '/') text.remove_prefix(1);
  return text;
}

void WriteGid(const Guid& guid, std::size_t size, CdrWriter* w) {
  w->Bytes({guid.data(), guid.size()});
  for (std::size_t i = guid.size(); i < size; ++i) w->U8(0);
}

void WriteGids(const std::vector<Guid>& guids, std::size_t size, CdrWriter* w) {
  w->U32(static_cast<std::uint32_t>(guids.size()));
  for (const Guid& guid : guids) WriteGid(guid, size, w);
}

}  // namespace

std::optional<NodeName> ParseNodeName(std::string_view text) {
  text = WithoutSlash(text);
  if (!IsPath(text)) return std::nullopt;
  const std::size_t slash = text.rfind('/');
  if (slash == std::string_view::npos) return NodeName{"/", std::string(text)};
  return NodeName{"/" + std::string(text.substr(0, slash)), std::string(text.substr(slash + 1))};
}

std::string ToNodeName(std::string_view text) {
  std::string name(text.substr(0, kMaxName - 1));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !IsWordCharacter(c); }, '_');
  return name.empty() || IsDigit(name.front()) ? "_" + name : name;
}

std::optional<std::string> ToDdsTopic(std::string_view ros_topic) {
  ros_topic = WithoutSlash(ros_topic);
  if (!IsPath(ros_topic)) return std::nullopt;
  return "rt/" + std::string(ros_topic);
}

std::vector<std::uint8_t> WriteParticipantEntities(const ParticipantEntities& entities,
                                                   std::size_t gid_size) {
  std::vector<std::uint8_t> out;
  CdrWriter w(&out);
  WriteGid(entities.participant, gid_size, &w);
  w.U32(1);
  w.Text(entities.node.name_space);
  w.Text(entities.node.name);
  WriteGids(entities.readers, gid_size, &w);
  WriteGids(entities.writers, gid_size, &w);
  return out;
}

}  // namespace lidar::cdr
