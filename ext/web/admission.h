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

  /// Wrong tokens that an address may name at once, and the time in which it wins one back.
  static constexpr double kWrongTokens = 10;
  static constexpr gint64 kForgive_us = 6 * gint64{G_USEC_PER_SEC};

 private:
  struct Wrong {
    double count = 0;
    gint64 at_us = 0;
  };
  std::optional<Grant> GrantFor(std::string_view token) const;
  bool HasToken() const { return !config_.token.empty() || !config_.token_secret.empty(); }
  /// Wrong tokens of the address that are not forgiven yet.
  double WrongOf(const std::string& address, gint64 now_us) const;
  void NoteWrong(const std::string& address, gint64 now_us);

  const ServerConfig& config_;
  std::map<std::string, Wrong> wrong_;  // by address
};

}  // namespace lidar::web
