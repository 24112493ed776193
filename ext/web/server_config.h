// SPDX-License-Identifier: LGPL-2.1-or-later
// The settings and counters of a server.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "src/base/units.h"

namespace lidar::web {

/// The channel on which ServerConfig::statistics is published.
inline constexpr const char* kStatisticsTopic = "/statistics";

struct ServerConfig {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;       // 0: any free port
  std::string token;            // admits all clients if both tokens are empty
  std::string token_secret;     // for signed tokens; empty: none
  std::string allowed_origins;  // pages that need no token: "https://a,https://b"
  std::string certificate;      // PEM file of the certificate and its chain; empty: no TLS
  std::string private_key;      // PEM file
  std::function<void(std::string)> warn;  // warnings for a user; called in the server's thread
  unsigned max_clients = 8;
  DataRate max_bitrate;                     // for the slices of a viewer; 0: no limit
  std::string name;                         // name that clients show
  std::function<std::string()> statistics;  // JSON; called in the server's thread
};

/// Counters that the server's thread writes, and that any thread may read.
struct ServerCounters {
  using Count = std::atomic<std::uint64_t>;
  Count clients{0};
  Count clients_accepted{0};
  Count clients_refused{0};  // by Admission, or because of max_clients
  Count messages_sent{0};
  Count messages_dropped{0};  // a slow client gets a newer message instead
  Count bytes_sent{0};
  Count scans_skipped{0};        // a slow viewer of slices gets a newer scan instead
  Count malformed{0};            // requests and messages that violate the protocol
  Count connections_evicted{0};  // because they were too slow or too many
};

}  // namespace lidar::web
