// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/grant.h"

#include <glib.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "src/base/base64.h"

namespace lidar::web {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestToken = 4096;

/// Decodes URL-safe Base64 (RFC 4648, section 5).
std::string FromBase64Url(std::string_view text) {
  std::string usual(text);
  std::replace(usual.begin(), usual.end(), '-', '+');
  std::replace(usual.begin(), usual.end(), '_', '/');
  const auto bytes = FromBase64(usual);
  return {bytes.begin(), bytes.end()};
}

std::string HmacSha256(std::string_view secret, std::string_view text) {
  GHmac* hmac =
      g_hmac_new(G_CHECKSUM_SHA256, reinterpret_cast<const guchar*>(secret.data()), secret.size());
  g_hmac_update(hmac, reinterpret_cast<const guchar*>(text.data()),
                static_cast<gssize>(text.size()));
  std::array<guint8, 32> digest{};
  gsize size = digest.size();
  g_hmac_get_digest(hmac, digest.data(), &size);
  g_hmac_unref(hmac);
  return {digest.begin(), digest.begin() + size};
}

/// Returns true if the token is signed by HS256. Refuses a header with critical extensions (RFC
/// 7515), because none of them is implemented.
bool IsHs256(const json& header) {
  const auto alg = header.is_object() ? header.find("alg") : header.end();
  return header.is_object() && alg != header.end() && *alg == "HS256" && !header.contains("crit");
}

std::optional<double> NumberOf(const json& claims, const char* name) {
  const auto found = claims.find(name);
  if (found == claims.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

/// Returns the texts in `list`. Returns nothing if `list` is not an array of texts.
std::optional<std::vector<std::string>> TextsOf(const json& list) {
  std::vector<std::string> texts;
  if (!list.is_array()) return std::nullopt;
  for (const json& item : list) {
    if (!item.is_string()) return std::nullopt;
    texts.push_back(item);
  }
  return texts;
}

std::optional<Grant> GrantOf(const json& claims, std::int64_t now_s) {
  constexpr double kLastTime = 1e15;
  if (!claims.is_object()) return std::nullopt;
  const auto expires = NumberOf(claims, "exp");
  if (!expires || *expires < 0 || *expires > kLastTime) return std::nullopt;
  if (claims.contains("nbf") &&
      NumberOf(claims, "nbf").value_or(kLastTime) > static_cast<double>(now_s))
    return std::nullopt;
  Grant grant;
  grant.expires_s = static_cast<std::int64_t>(*expires);
  if (claims.contains("topics")) {
    grant.topics = TextsOf(claims["topics"]);
    if (!grant.topics) return std::nullopt;
  }
  if (grant.IsOver(now_s)) return std::nullopt;
  return grant;
}

}  // namespace

bool SameSecret(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < a.size() && !b.empty(); ++i)
    difference |= static_cast<unsigned>(a[i] ^ b[i % b.size()]);
  return difference == 0;
}

bool Grant::Allows(std::string_view topic) const {
  if (!topics) return true;
  return std::any_of(topics->begin(), topics->end(), [topic](std::string_view allowed) {
    constexpr std::string_view kAllBelow = "/*";
    const bool is_prefix = allowed.size() >= kAllBelow.size() &&
                           allowed.substr(allowed.size() - kAllBelow.size()) == kAllBelow;
    if (!is_prefix) return topic == allowed;
    allowed.remove_suffix(1);
    return topic.substr(0, allowed.size()) == allowed;
  });
}

std::optional<Grant> ReadSignedToken(std::string_view token, std::string_view secret,
                                     std::int64_t now_s) {
  if (token.size() > kLongestToken) return std::nullopt;
  const auto first = token.find('.');
  const auto last = token.rfind('.');
  if (first == last || token.find('.', first + 1) != last) return std::nullopt;
  const std::string signature = FromBase64Url(token.substr(last + 1));
  if (!SameSecret(signature, HmacSha256(secret, token.substr(0, last)))) return std::nullopt;
  const auto header = json::parse(FromBase64Url(token.substr(0, first)), nullptr, false);
  const auto claims =
      json::parse(FromBase64Url(token.substr(first + 1, last - first - 1)), nullptr, false);
  if (!IsHs256(header)) return std::nullopt;
  return GrantOf(claims, now_s);
}

}  // namespace lidar::web
