// SPDX-License-Identifier: LGPL-2.1-or-later
// The rights that a token gives, and tokens that contain their rights.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lidar::web {

/// Compares two secrets. The time depends only on their lengths, so it does not reveal how long the
/// common prefix is.
bool SameSecret(std::string_view a, std::string_view b);

struct Grant {
  std::optional<std::int64_t> expires_s;           // Unix time
  std::optional<std::vector<std::string>> topics;  // missing: all; "/r7/*": all below /r7

  bool IsOver(std::int64_t now_s) const { return expires_s && now_s >= *expires_s; }
  bool Allows(std::string_view topic) const;
};

/// Reads a JSON Web Token (RFC 7519) that is signed by HS256 with `secret`. The token needs the
/// claim `exp`. It may have the claims `nbf` and `topics`, an array of texts. Returns nothing if
/// the token is damaged, has a wrong signature, has expired, or is not yet valid.
std::optional<Grant> ReadSignedToken(std::string_view token, std::string_view secret,
                                     std::int64_t now_s);

}  // namespace lidar::web
