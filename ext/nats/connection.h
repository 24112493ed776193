// SPDX-License-Identifier: LGPL-2.1-or-later
// A connection to NATS that comes back by itself.
#pragma once
#include <nats/nats.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "ext/nats/nats_ptr.h"

namespace lidar::nats {

struct ConnectionSettings {
  std::string url = "nats://localhost:4222";  // more than one: with commas between them
  std::string name;                           // as the server's monitoring shows it
  std::string credentials_file;
  std::string token;
  std::string tls_ca_file;
  std::string tls_cert_file;
  std::string tls_key_file;
};

struct ConnectionState {
  bool connected() const { return connections > disconnections && !closed; }

  bool closed = false;       // for good: the server refuses us
  unsigned connections = 0;  // made so far
  unsigned disconnections = 0;
  std::uint64_t errors = 0;  // that the server told us of
  std::string last_error;    // empty: none yet
  // How often JetStream's consumers fell silent: the server may have lost them.
  unsigned missed_heartbeats = 0;
};

class Connection {
 public:
  /// `changed` runs in threads of libnats, at each change of the state until the destructor
  /// returns. Null, and `why`, where the settings are wrong. A server that is away is none: it is
  /// tried until it is there.
  using Changed = std::function<void(const ConnectionState&)>;
  static std::unique_ptr<Connection> Open(const ConnectionSettings& settings, Changed changed,
                                          std::string* why);
  /// Waits for a connect or a write that is under way: kConnectTimeoutMs, kWriteTimeoutMs.
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  natsConnection* get() const { return nc_; }
  /// Never waits for the network.
  ConnectionState state() const;
  /// How often it was made anew: known before anything can be sent on the new one. For one thread.
  std::uint64_t reconnects() const;

  static constexpr std::int64_t kConnectTimeoutMs = 1'000;
  static constexpr std::int64_t kWriteTimeoutMs = 1'000;

 private:
  struct Shared;
  using SharedPtr = std::shared_ptr<Shared>;
  explicit Connection(SharedPtr shared) : shared_(std::move(shared)) {}
  natsStatus Connect(natsOptions* options);

  const SharedPtr shared_;    // with the callbacks, which may outlive this by a moment
  StatisticsPtr statistics_;  // of reconnects(), which is asked for each message
  natsConnection* nc_ = nullptr;
};

/// A server that is away for as long is told of.
constexpr std::chrono::seconds kAbsence{2};
/// URLs for a user to read: without what is secret in them.
std::string WithoutUser(const std::string& urls);

/// The words of libnats for `status`, with what it knows beside.
std::string ErrorText(natsStatus status);

}  // namespace lidar::nats
