// SPDX-License-Identifier: LGPL-2.1-or-later
// The part of the server that runs in its thread: HTTP, handshakes, clients and their
// subscriptions.
#pragma once
#include <libsoup/soup.h>

#include <list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ext/web/admission.h"
#include "ext/web/certificate.h"
#include "ext/web/client.h"
#include "ext/web/front_door.h"
#include "ext/web/glib_ptr.h"
#include "ext/web/server_config.h"
#include "ext/web/slice_service.h"
#include "ext/web/topic.h"

namespace lidar::web {

/// Serves clients by HTTP and WebSocket. Only one thread may call it, and its sources run in that
/// thread's default context.
class ClientService {
 public:
  ClientService(const ServerConfig& config, ServerCounters* counters);
  ~ClientService();
  ClientService(const ClientService&) = delete;
  ClientService& operator=(const ClientService&) = delete;

  /// Starts to listen. Returns the port. If listening fails, returns 0 and sets `error`.
  std::uint16_t Listen(std::string* error);
  /// Replaces the topics. Announces new and removed topics to the clients.
  void SetTopics(const std::vector<SharedTopic>& topics);
  void Deliver(std::uint32_t channel, const SharedMessage& message);
  void DeliverSlice(std::uint32_t channel, const SharedSliceMessage& slice);

 private:
  static void OnHeaders(SoupServer*, SoupServerMessage*, const char*, GHashTable*, gpointer self);
  static void OnRequest(SoupServer*, SoupServerMessage*, const char* path, GHashTable* query,
                        gpointer self);
  static void OnUpgraded(SoupServerMessage*, gpointer self);
  /// Returns the grant of the request. If the request is refused, answers it and returns nothing.
  std::optional<Grant> Admit(SoupServerMessage* request, GHashTable* query);
  void Upgrade(SoupServerMessage* request);
  void AddClient(SoupServerMessage* request);
  void RenewCertificate();
  void WarnOfEnd();

  void Advertise(Client* client, std::vector<foxglove::Channel> channels);
  void OnText(Client* client, const std::vector<std::uint8_t>& text);
  void Subscribe(Client* client, const foxglove::Subscription& subscription);
  void Unsubscribe(Client* client, std::uint32_t subscription_id);
  void ForgetClient(Client* client);
  void Reap();
  void CountSent();

  SourcePtr Every(guint interval_ms, GSourceFunc function);
  void Tick();
  void SendStatistics();

  const ServerConfig& config_;
  ServerCounters& counters_;
  const std::string session_id_;
  Admission admission_;
  Certificate certificate_;
  ObjectPtr<SoupServer> soup_;
  FrontDoor door_;
  std::list<std::unique_ptr<Client>> clients_;
  Client::Counters gone_;  // sums over the clients that have been removed
  std::map<std::uint32_t, SharedTopic> topics_;
  SharedTopic statistics_;  // always present
  SliceService slices_;
  SourcePtr reap_;
  SourcePtr tick_;
  SourcePtr statistics_timer_;
};

}  // namespace lidar::web
