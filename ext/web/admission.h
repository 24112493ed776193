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

/// The address of a client: the peer, or the last that a proxy on this machine forwards for.
std::string AddressOf(GInetAddress* peer, std::string_view forwarded);

/// Counts wrong tokens by address, and forgives them one by one.
class WrongTokens {
 public:
  /// Wrong tokens that an address may name at once, and the time in which it wins one back.
  static constexpr double kMost = 10;
  static constexpr gint64 kForgive_us = 6 * gint64{G_USEC_PER_SEC};
  static constexpr std::size_t kMostAddresses = 1024;

  /// False for an address that has named too many.
  bool MayTry(const std::string& address, gint64 now_us) const {
    return CountOf(address, now_us) + 1 <= kMost;
  }
  /// The address that was wrong longest ago gives way.
  void Note(const std::string& address, gint64 now_us);

 private:
  struct Wrong {
    double count = 0;
    gint64 at_us = 0;
  };
  /// Wrong tokens that are not forgiven yet.
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
  /// The grant of the request, or the refusal that answers it.
  std::optional<Grant> Check(SoupServerMessage* request, GHashTable* query, Refusal* refusal);

 private:
  std::optional<Grant> GrantFor(std::string_view token) const;
  bool HasToken() const { return !config_.token.empty() || !config_.token_secret.empty(); }

  const ServerConfig& config_;
  WrongTokens wrong_;
};

}  // namespace lidar::web
