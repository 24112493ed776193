// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes untrusted text safe for a terminal or a log.
#pragma once
#include <glib.h>

#include <cstdio>
#include <string>

namespace lidar::tools {

/// Replaces bytes that are not printable UTF-8 by \xNN. The text then stays on a single line, and
/// has no control sequences for a terminal.
inline std::string Printable(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const char* const begin = text.data() + at;
    const gunichar c = g_utf8_get_char_validated(begin, static_cast<gssize>(text.size() - at));
    const bool valid = g_unichar_validate(c) != FALSE;
    const auto size = valid ? static_cast<std::size_t>(g_utf8_next_char(begin) - begin) : 1;
    if (valid && g_unichar_isprint(c) != FALSE) {
      out.append(begin, size);
    } else {
      for (std::size_t i = 0; i < size; ++i) {
        char code[5];
        std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned char>(begin[i]));
        out += code;
      }
    }
    at += size;
  }
  return out;
}

/// Returns an address as it is written in a URL, with brackets around an IPv6 address.
inline std::string HostInUrl(const std::string& address) {
  return address.find(':') == address.npos ? address : "[" + address + "]";
}

}  // namespace lidar::tools
