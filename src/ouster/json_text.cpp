// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/json_text.h"

#include <nlohmann/json.hpp>

namespace lidar::ouster {
namespace {

/// Counts brackets and strings before the text is parsed. The parser's callback could count them,
/// too, but would take time that is quadratic in the number of objects.
bool IsWithinBounds(std::string_view text) {
  int depth = 0;
  std::size_t items = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
      ++items;
    } else if (c == '[' || c == '{') {
      ++items;
      if (++depth > kMaxJsonDepth) return false;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return items <= kMaxJsonItems;
}

}  // namespace

nlohmann::json ParseJson(std::string_view text) {
  using nlohmann::json;
  if (!IsWithinBounds(text)) return json(json::value_t::discarded);
  return json::parse(text, nullptr, /*allow_exceptions=*/false);
}

nlohmann::json ParseJsonObject(std::string_view text) {
  nlohmann::json root = ParseJson(text);
  if (!root.is_object()) root = nlohmann::json(nlohmann::json::value_t::discarded);
  return root;
}

}  // namespace lidar::ouster
