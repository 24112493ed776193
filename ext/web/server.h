// SPDX-License-Identifier: LGPL-2.1-or-later
// A server for Foxglove's WebSocket protocol and for its own page. It runs in a thread of its own.
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

/// A server for viewers. Any thread may call its public functions, which never wait for a client.
class Server {
 public:
  /// Starts a server. If it cannot listen, returns nothing and sets `error` to a text for users.
  static std::unique_ptr<Server> Start(ServerConfig config, std::string* error);
  /// Ends all connections.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const { return port_; }
  const ServerCounters& counters() const { return counters_; }

  /// Opens the channel `topic`. Several inputs may share a channel unless it has slices. `stream`
  /// describes the slices. Viewers may request earlier slices from `recording`. Returns nothing if
  /// the topic is open with another schema.
  SharedTopic Open(const std::string& topic, foxglove::Schema schema, std::string stream = {},
                   std::shared_ptr<Recording> recording = {});
  /// Closes the channel after all inputs that opened it have called this function.
  void Close(const SharedTopic& topic);
  /// Queue data for the server's thread. If too many messages wait, the oldest are dropped.
  void Publish(const SharedTopic& topic, Message message);
  void PublishSlice(const SharedTopic& topic, SharedSliceMessage slice);

 private:
  struct Entry {
    SharedTopic topic;
    int users = 0;
  };
  explicit Server(ServerConfig config);
  void Run(std::function<void(std::string)> listens);
  /// Makes the server's thread call Collect().
  void WakeLocked();
  static gboolean OnWake(gpointer self);
  void Collect();

  const ServerConfig config_;
  ServerCounters counters_;
  std::uint16_t port_ = 0;
  ContextPtr context_;
  LoopPtr loop_;
  std::thread thread_;
  std::unique_ptr<ClientService> service_;  // used only by the thread

  std::mutex mutex_;                      // guards the members below; not locked during calls
  std::map<std::string, Entry> entries_;  // by topic
  Outbox inbox_;                          // messages for the thread
  std::deque<std::pair<std::uint32_t, SharedSliceMessage>> slices_;  // also, by channel
  std::uint32_t next_id_ = 1;
  bool wake_pending_ = false;
};

}  // namespace lidar::web
