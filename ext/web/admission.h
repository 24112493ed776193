// SPDX-License-Identifier: LGPL-2.1-or-later
// Admits clients by their token and by the origin of their page, and limits wrong tokens.
#pragma once
#include <libsoup/soup.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "ext/web/grant.h"
#include "ext/web/server_config.h"

namespace lidar::web {

/// Returns the address of a client. This is the address of the peer, or the last address in
/// `forwarded` if the peer is a proxy on this machine.
std::string AddressOf(GInetAddress* peer, std::string_view forwarded);

/// A counter of the wrong tokens from each address. One wrong token is forgiven after each interval
/// kForgive_us.
class WrongTokens {
 public:
  /// The number of wrong tokens that an address may send at once, and the time after which it may
  /// send another one.
  static constexpr double kMost = 10;
  static constexpr gint64 kForgive_us = 6 * gint64{G_USEC_PER_SEC};
  static constexpr std::size_t kMostAddresses = 1024;

  /// Returns false if too many wrong tokens came from the address.
  bool MayTry(const std::string& address, gint64 now_us) const {
    return CountOf(address, now_us) + 1 <= kMost;
  }
  /// Counts a wrong token. If there are too many addresses, removes the address whose last wrong
  /// token is the oldest.
  void Note(const std::string& address, gint64 now_us);

 private:
  struct Wrong {
    double count = 0;
    gint64 at_us = 0;
  };
  /// Returns the number of wrong tokens that are not yet forgiven.
  double CountOf(const std::string& address, gint64 now_us) const;

  std::map<std::string, Wrong> wrong_;
};

/// Decides which requests are admitted. Only the server's thread may use it.
class Admission {
 public:
  explicit Admission(const ServerConfig& config) : config_(config) {}

  struct Refusal {
    guint status = SOUP_STATUS_UNAUTHORIZED;
    const char* text = "";
  };
  /// Returns the rights that the request has. If it has none, returns nothing and sets `refusal` to
  /// the answer.
  std::optional<Grant> Check(SoupServerMessage* request, GHashTable* query, Refusal* refusal);

 private:
  std::optional<Grant> GrantFor(std::string_view token) const;
  bool HasToken() const { return !config_.token.empty() || !config_.token_secret.empty(); }

  const ServerConfig& config_;
  WrongTokens wrong_;
};

}  // namespace lidar::web
