// SPDX-License-Identifier: LGPL-2.1-or-later
// A connection to NATS that reconnects by itself.
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
  std::string url = "nats://localhost:4222";  // several have commas between them
  std::string name;                           // shown by the server's monitoring
  std::string credentials_file;
  std::string token;
  std::string tls_ca_file;
  std::string tls_cert_file;
  std::string tls_key_file;
};

struct ConnectionState {
  bool connected() const { return connections > disconnections && !closed; }

  bool refused() const { return closed && !unanswered; }

  bool closed = false;  // for good, so that only another connection helps
  // libnats gave up the first connect: no server refused, but one accepted and then stayed silent.
  bool unanswered = false;
  unsigned connections = 0;  // number of connects so far
  unsigned disconnections = 0;
  std::uint64_t errors = 0;  // number of the server's error reports
  std::string last_error;    // the latest report, or empty
  // Number of missed heartbeats of JetStream's consumers. The server may have lost the consumer.
  unsigned missed_heartbeats = 0;
};

class Connection {
 public:
  using Changed = std::function<void(const ConnectionState&)>;
  /// `changed` runs in threads of libnats, at each change of the state until the destructor
  /// returns. Returns null, and `why`, if the settings are wrong. A server that does not answer is
  /// not an error: the connection tries again until a server answers, or is given up as
  /// `unanswered`.
  static std::unique_ptr<Connection> Open(const ConnectionSettings& settings, Changed changed,
                                          std::string* why);
  /// Waits for a connect (kConnectTimeoutMs) or a write (kWriteTimeoutMs) that is under way.
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  natsConnection* get() const { return nc_; }
  /// Closes the connection. Subscriptions that end later do not wait for the server.
  void Close() { natsConnection_Close(nc_); }
  /// Never waits for the network.
  ConnectionState state() const;
  /// Returns true if there was a reconnect since the last call. libnats counts a reconnect before
  /// the new connection can send. For one thread.
  bool TakeReconnect();

  static constexpr std::int64_t kConnectTimeoutMs = 1'000;
  static constexpr std::int64_t kWriteTimeoutMs = 1'000;

 private:
  struct Shared;
  using SharedPtr = std::shared_ptr<Shared>;
  explicit Connection(SharedPtr shared) : shared_(std::move(shared)) {}
  natsStatus Connect(natsOptions* options);

  const SharedPtr shared_;    // shared with callbacks, which may outlive this object
  StatisticsPtr statistics_;  // kept, because TakeReconnect() reads it for each message
  std::uint64_t reconnects_ = 0;
  natsConnection* nc_ = nullptr;
};

/// Time without a server until there is a warning.
constexpr std::chrono::seconds kAbsence{2};
/// Returns the URLs without their secrets, for messages to users.
std::string WithoutUser(const std::string& urls);

/// Returns libnats' text for `status`, and its last error.
std::string ErrorText(natsStatus status);

}  // namespace lidar::nats
