// SPDX-License-Identifier: LGPL-2.1-or-later
// The rights of a token, and tokens that carry them.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lidar::web {

/// Takes a time that depends on the lengths only, so that it does not leak a matching prefix.
bool SameSecret(std::string_view a, std::string_view b);

struct Grant {
  std::optional<std::int64_t> expires_s;           // of Unix time
  std::optional<std::vector<std::string>> topics;  // missing: all; "/r7/*" is all below /r7

  bool IsOver(std::int64_t now_s) const { return expires_s && now_s >= *expires_s; }
  bool Allows(std::string_view topic) const;
};

/// Reads a JSON Web Token (RFC 7519) signed by HS256 with `secret`. It needs the claim `exp`, and
/// may have `nbf` and `topics`, an array of texts. Returns nothing for a token that is damaged,
/// signed otherwise, expired, or not yet valid.
std::optional<Grant> ReadSignedToken(std::string_view token, std::string_view secret,
                                     std::int64_t now_s);

}  // namespace lidar::web
