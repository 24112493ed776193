// SPDX-License-Identifier: LGPL-2.1-or-later
// A cluster of three nats-servers with replicated streams.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "ext/nats/connection.h"
#include "ext/nats/jetstream.h"
#include "tests/elements/nats/nats_server.h"
#include "tests/support/free_ports.h"

namespace lidar::test {

constexpr std::size_t kServers = 3;

/// Waits until `holds` returns true. Waits up to twice as long as Eventually(), because clusters
/// are slow.
inline bool WaitFor(const std::function<bool()>& holds) {
  return Eventually(holds) || Eventually(holds);
}

class Cluster {
 public:
  void Start() {
    std::string routes;
    std::vector<std::string> addresses;
    for (std::size_t i = 0; i < kServers; ++i) {
      addresses.push_back("nats://127.0.0.1:" + std::to_string(FreeTcpPort()));
      routes += (i > 0 ? "," : "") + addresses.back();
    }
    for (std::size_t i = 0; i < kServers; ++i)
      servers_[i].Start({"--server_name", Name(i), "--cluster_name", "fleet", "--cluster",
                         addresses[i], "--routes", routes});
    nats::ConnectionSettings settings;
    settings.url = url();
    std::string why;
    connection_ = nats::Connection::Open(settings, nullptr, &why);
    ASSERT_TRUE(connection_) << why;
    js_ = nats::OpenJetStream(connection_->get());
  }
  static std::string Name(std::size_t i) { return "server-" + std::to_string(i); }
  std::string url() const {
    std::string list;
    for (const NatsServer& server : servers_) list += (list.empty() ? "" : ",") + server.url();
    return list;
  }
  NatsServer& server(std::size_t i) { return servers_[i]; }
  jsCtx* js() { return js_.get(); }
  /// Returns the name of the stream's leader, or an empty string if the stream has no leader or if
  /// a replica is missing or incomplete.
  std::string LeaderOf(const char* stream) {
    jsStreamInfo* raw = nullptr;
    if (js_GetStreamInfo(&raw, js_.get(), stream, nullptr, nullptr) != NATS_OK) return "";
    const nats::StreamInfoPtr info(raw);
    const jsClusterInfo* cluster = info->Cluster;
    if (cluster == nullptr || cluster->Leader == nullptr) return "";
    if (cluster->ReplicasLen != static_cast<int>(kServers) - 1) return "";
    for (int i = 0; i < cluster->ReplicasLen; ++i)
      if (!cluster->Replicas[i]->Current || cluster->Replicas[i]->Offline) return "";
    return cluster->Leader;
  }

 private:
  NatsServer servers_[kServers];
  std::unique_ptr<nats::Connection> connection_;
  nats::JetStreamPtr js_;
};

}  // namespace lidar::test
