// SPDX-License-Identifier: LGPL-2.1-or-later
// Admits clients by their token and the origin of their page, and bounds wrong tokens.
#pragma once
#include <libsoup/soup.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "ext/web/grant.h"
#include "ext/web/server_config.h"

namespace lidar::web {

/// Returns a client's address: the peer's, or the last address in `forwarded` if the peer is a
/// proxy on this machine.
std::string AddressOf(GInetAddress* peer, std::string_view forwarded);

/// Counts wrong tokens by address, and forgives them one by one.
class WrongTokens {
 public:
  /// Number of wrong tokens that an address may send at once, and the time after which it may send
  /// one more.
  static constexpr double kMost = 10;
  static constexpr gint64 kForgive_us = 6 * gint64{G_USEC_PER_SEC};
  static constexpr std::size_t kMostAddresses = 1024;

  /// Returns false for an address with too many wrong tokens.
  bool MayTry(const std::string& address, gint64 now_us) const {
    return CountOf(address, now_us) + 1 <= kMost;
  }
  /// A new address replaces the one whose wrong token is oldest.
  void Note(const std::string& address, gint64 now_us);

 private:
  struct Wrong {
    double count = 0;
    gint64 at_us = 0;
  };
  /// Number of wrong tokens that still count.
  double CountOf(const std::string& address, gint64 now_us) const;

  std::map<std::string, Wrong> wrong_;
};

/// For the server's thread.
class Admission {
 public:
  explicit Admission(const ServerConfig& config) : config_(config) {}

  struct Refusal {
    guint status = SOUP_STATUS_UNAUTHORIZED;
    const char* text = "";
  };
  /// Returns the grant of the request, or the refusal to answer with.
  std::optional<Grant> Check(SoupServerMessage* request, GHashTable* query, Refusal* refusal);

 private:
  std::optional<Grant> GrantFor(std::string_view token) const;
  bool HasToken() const { return !config_.token.empty() || !config_.token_secret.empty(); }

  const ServerConfig& config_;
  WrongTokens wrong_;
};

}  // namespace lidar::web
