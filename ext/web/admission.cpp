// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/admission.h"

#include <algorithm>

#include "ext/web/glib_ptr.h"

namespace lidar::web {
namespace {

std::string_view HeaderOf(SoupServerMessage* request, const char* name) {
  const char* text =
      soup_message_headers_get_one(soup_server_message_get_request_headers(request), name);
  return text != nullptr ? text : "";
}

std::string_view TokenOf(SoupServerMessage* request, GHashTable* query) {
  const auto* in_query =
      query != nullptr ? static_cast<const char*>(g_hash_table_lookup(query, "token")) : nullptr;
  if (in_query != nullptr) return in_query;
  // Names of schemes are case-insensitive (RFC 9110, section 11.1).
  constexpr std::string_view kBearer = "Bearer ";
  const std::string_view text = HeaderOf(request, "Authorization");
  const bool is_bearer = g_ascii_strncasecmp(text.data(), kBearer.data(), kBearer.size()) == 0;
  return is_bearer ? text.substr(kBearer.size()) : "";
}

std::string PeerOf(SoupServerMessage* request) {
  auto* peer = soup_server_message_get_remote_address(request);
  if (peer == nullptr || !G_IS_INET_SOCKET_ADDRESS(peer)) return "";
  return AddressOf(g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(peer)),
                   HeaderOf(request, "X-Forwarded-For"));
}

/// Returns "robot:8765" of "https://robot:8765".
std::string_view WithoutScheme(std::string_view origin) {
  const auto slashes = origin.find("://");
  return slashes == std::string_view::npos ? origin : origin.substr(slashes + 3);
}

std::string_view WithoutPort(std::string_view host) {
  const auto colon = host.rfind(':');
  const bool is_port = colon != std::string_view::npos && host.back() != ']';
  return is_port ? host.substr(0, colon) : host;
}

bool Lists(std::string_view list, std::string_view item) {
  while (!list.empty()) {
    list.remove_prefix(std::min(list.find_first_not_of(' '), list.size()));
    const auto comma = std::min(list.find(','), list.size());
    if (list.substr(0, comma) == item) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

/// Returns true if `host` is an address or localhost. Names are refused, because any site can make
/// a name of its own point to this server.
bool IsNoName(std::string_view host) {
  if (host.size() > 2 && host.front() == '[') host = host.substr(1, host.size() - 2);
  return host.empty() || host == "localhost" || g_hostname_is_ip_address(std::string(host).c_str());
}

/// Returns true if the page that sends the request is the server's own page, or if its origin is in
/// `allowed`. Clients other than browsers send no origin.
bool IsOwnPage(SoupServerMessage* request, const std::string& allowed) {
  const std::string_view origin = HeaderOf(request, "Origin");
  if (!origin.empty() && Lists(allowed, origin)) return true;
  const std::string_view host = WithoutPort(HeaderOf(request, "Host"));
  if (!IsNoName(host)) return false;
  return origin.empty() || WithoutPort(WithoutScheme(origin)) == host;
}

}  // namespace

std::string AddressOf(GInetAddress* peer, std::string_view forwarded) {
  if (g_inet_address_get_is_loopback(peer) && !forwarded.empty()) {
    const auto comma = forwarded.rfind(',');
    const auto begin = comma == std::string_view::npos ? 0 : comma + 1;
    return std::string(forwarded.substr(begin, 64));
  }
  gchar* text = g_inet_address_to_string(peer);
  std::string copy = text;
  g_free(text);
  return copy;
}

/// A valid token admits pages of any origin, because a browser never adds the token by itself.
std::optional<Grant> Admission::Check(SoupServerMessage* request, GHashTable* query,
                                      Refusal* refusal) {
  if (!HasToken()) {
    if (IsOwnPage(request, config_.allowed_origins)) return Grant{};
    *refusal = {SOUP_STATUS_FORBIDDEN,
                "Pages of other sites and other names of this host need a token, or "
                "allowed-origins.\n"};
    return std::nullopt;
  }
  const std::string address = PeerOf(request);
  const gint64 now_us = g_get_monotonic_time();
  if (!wrong_.MayTry(address, now_us)) {
    *refusal = {429, "Too many wrong tokens came from this address: wait a minute.\n"};
    return std::nullopt;
  }
  const std::string_view token = TokenOf(request, query);
  auto grant = GrantFor(token);
  if (grant) return grant;
  if (!token.empty()) wrong_.Note(address, now_us);
  *refusal = {SOUP_STATUS_UNAUTHORIZED,
              token.empty() ? "A token is needed.\n" : "The token is wrong, or has expired.\n"};
  return std::nullopt;
}

std::optional<Grant> Admission::GrantFor(std::string_view token) const {
  if (!config_.token.empty() && SameSecret(token, config_.token)) return Grant{};
  if (config_.token_secret.empty()) return std::nullopt;
  return ReadSignedToken(token, config_.token_secret, g_get_real_time() / G_USEC_PER_SEC);
}

double WrongTokens::CountOf(const std::string& address, gint64 now_us) const {
  const auto found = wrong_.find(address);
  if (found == wrong_.end()) return 0;
  const double forgiven =
      static_cast<double>(now_us - found->second.at_us) / static_cast<double>(kForgive_us);
  return std::max(found->second.count - forgiven, 0.0);
}

void WrongTokens::Note(const std::string& address, gint64 now_us) {
  const double count = CountOf(address, now_us) + 1;
  wrong_[address] = {count, now_us};
  if (wrong_.size() <= kMostAddresses) return;
  wrong_.erase(std::min_element(wrong_.begin(), wrong_.end(), [](const auto& a, const auto& b) {
    return a.second.at_us < b.second.at_us;
  }));
}

}  // namespace lidar::web
