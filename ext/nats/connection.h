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
  std::string url = "nats://localhost:4222";  // several URLs are separated by commas
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

  bool closed = false;  // libnats does not connect again by itself
  // True if libnats gave up the first connect because a server accepted the TCP connection but
  // never answered.
  bool unanswered = false;
  unsigned connections = 0;  // number of connects so far
  unsigned disconnections = 0;
  std::uint64_t errors = 0;  // number of the server's error reports
  std::string last_error;    // text of the latest report, or empty
  // Number of missed heartbeats of JetStream's consumers. If a heartbeat is missing, the server may
  // have lost the consumer.
  unsigned missed_heartbeats = 0;
};

class Connection {
 public:
  using Changed = std::function<void(const ConnectionState&)>;
  /// Opens a connection. Threads of libnats call `changed` at each change of the state, until the
  /// destructor returns. Returns null and sets `why` if the settings are wrong. A server that does
  /// not answer is not an error: the connection tries again until a server answers, or until
  /// libnats gives up (see `unanswered`).
  static std::unique_ptr<Connection> Open(const ConnectionSettings& settings, Changed changed,
                                          std::string* why);
  /// Waits for a connect or a write that is in progress, for at most kConnectTimeoutMs or
  /// kWriteTimeoutMs.
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  natsConnection* get() const { return nc_; }
  /// Closes the connection. A subscription that is destroyed after this call does not wait for the
  /// server.
  void Close() { natsConnection_Close(nc_); }
  /// Returns the state. Never waits for the network.
  ConnectionState state() const;
  /// Returns true if libnats has reconnected since the last call. libnats counts a reconnect before
  /// messages can be sent over the new connection. Only one thread may call this function.
  bool TakeReconnect();

  static constexpr std::int64_t kConnectTimeoutMs = 1'000;
  static constexpr std::int64_t kWriteTimeoutMs = 1'000;

 private:
  struct Shared;
  using SharedPtr = std::shared_ptr<Shared>;
  explicit Connection(SharedPtr shared) : shared_(std::move(shared)) {}
  natsStatus Connect(natsOptions* options);

  const SharedPtr shared_;    // shared with callbacks, which may outlive this object
  StatisticsPtr statistics_;  // allocated once, because TakeReconnect() reads it for each message
  std::uint64_t reconnects_ = 0;
  natsConnection* nc_ = nullptr;
};

/// The time without a server after which a warning is posted.
constexpr std::chrono::seconds kAbsence{2};
/// Returns the URLs without user names and passwords, to be shown to users.
std::string WithoutUser(const std::string& urls);

/// Returns the text of libnats' last error if that error has this `status`. Otherwise returns
/// libnats' text for `status`.
std::string ErrorText(natsStatus status);

}  // namespace lidar::nats
