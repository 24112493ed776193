// SPDX-License-Identifier: LGPL-2.1-or-later
// A server of Foxglove's WebSocket protocol and of its own page, in a thread of its own.
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "ext/web/glib_ptr.h"
#include "ext/web/outbox.h"
#include "ext/web/server_config.h"
#include "ext/web/topic.h"

namespace lidar::web {

class ClientService;

/// All threads may call the public functions, which wait for no client.
class Server {
 public:
  /// Returns nothing if the server cannot listen; `error` then has the reason in words for a user.
  static std::unique_ptr<Server> Start(ServerConfig config, std::string* error);
  /// Ends all connections.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const { return port_; }
  const ServerCounters& counters() const { return counters_; }

  /// Opens the channel `topic`. Inputs may share a channel unless it has slices. `stream` describes
  /// the slices, and viewers may request earlier ones from `recording`. Returns nothing if the
  /// topic has another schema.
  SharedTopic Open(const std::string& topic, foxglove::Schema schema, std::string stream = {},
                   std::shared_ptr<Recording> recording = {});
  /// Closes the channel once all inputs that opened it have called this.
  void Close(const SharedTopic& topic);
  /// Queues the message for the server's thread. If too many wait, the oldest are dropped.
  void Publish(const SharedTopic& topic, Message message);
  void PublishSlice(const SharedTopic& topic, SharedSliceMessage slice);

 private:
  struct Entry {
    SharedTopic topic;
    int users = 0;
  };
  explicit Server(ServerConfig config);
  void Run(std::function<void(std::string)> listens);
  /// Makes the thread check topics and inboxes.
  void WakeLocked();
  static gboolean OnWake(gpointer self);
  void Collect();

  const ServerConfig config_;
  ServerCounters counters_;
  std::uint16_t port_ = 0;
  ContextPtr context_;
  LoopPtr loop_;
  std::thread thread_;
  std::unique_ptr<ClientService> service_;  // used by the thread only

  std::mutex mutex_;  // guards what follows; never held while anything is called
  std::map<std::string, Entry> entries_;                             // by topic
  Outbox inbox_;                                                     // for the thread
  std::deque<std::pair<std::uint32_t, SharedSliceMessage>> slices_;  // the same, by channel
  std::uint32_t next_id_ = 1;
  bool wake_pending_ = false;
};

}  // namespace lidar::web
