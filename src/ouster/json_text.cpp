// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/json_text.h"

#include <nlohmann/json.hpp>

namespace lidar::ouster {
namespace {

/// Whether brackets outside strings nest too deeply. A pass of its own: the parser's callback takes
/// time that is quadratic in the number of objects.
bool IsTooDeep(std::string_view text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMaxJsonDepth) return true;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return false;
}

}  // namespace

nlohmann::json ParseJsonObject(std::string_view text) {
  using nlohmann::json;
  json refused(json::value_t::discarded);
  if (IsTooDeep(text)) return refused;
  json root = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!root.is_object()) return refused;
  return root;
}

}  // namespace lidar::ouster
