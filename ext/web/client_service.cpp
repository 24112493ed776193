// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/client_service.h"

#include <algorithm>

#include "ext/web/page_files.h"

namespace lidar::web {
namespace {

using foxglove::CloseCode;
using foxglove::Request;

constexpr std::uint32_t kStatisticsId = 0;
constexpr guint kTick_ms = 1000;
constexpr guint kStatistics_ms = 250;
/// The key under which OnRequest() stores the client's grant in a request.
constexpr const char* kGrant = "grant";

void Answer(SoupServerMessage* request, guint status, const char* text) {
  soup_server_message_set_status(request, status, nullptr);
  soup_server_message_set_response(request, "text/plain; charset=utf-8", SOUP_MEMORY_COPY, text,
                                   strlen(text));
  auto* headers = soup_server_message_get_response_headers(request);
  soup_message_headers_replace(headers, "Cache-Control", "no-store");
  // RFC 9110, sections 15.5.2 and 15.5.6, requires these headers.
  if (status == SOUP_STATUS_UNAUTHORIZED)
    soup_message_headers_replace(headers, "WWW-Authenticate", "Bearer");
  if (status == SOUP_STATUS_METHOD_NOT_ALLOWED)
    soup_message_headers_replace(headers, "Allow", "GET, HEAD");
}

bool WantsWebSocket(SoupServerMessage* request) {
  return soup_message_headers_header_contains(soup_server_message_get_request_headers(request),
                                              "Upgrade", "websocket") != FALSE;
}

std::string NewSessionId() {
  gchar* uuid = g_uuid_string_random();
  std::string id = uuid;
  g_free(uuid);
  return id;
}

}  // namespace

ClientService::ClientService(const ServerConfig& config, ServerCounters* counters)
    : config_(config),
      counters_(*counters),
      session_id_(NewSessionId()),
      admission_(config),
      certificate_(config.certificate, config.private_key),
      soup_(soup_server_new("server-header", "gst-lidar", nullptr)),
      door_(soup_.get(), certificate_.is_wanted() ? &certificate_ : nullptr, {}),
      slices_(config.max_bitrate, config.warn) {
  soup_server_add_early_handler(soup_.get(), nullptr, OnHeaders, this, nullptr);
  soup_server_add_handler(soup_.get(), nullptr, OnRequest, this, nullptr);
  statistics_ = std::make_shared<Topic>(
      foxglove::Channel{kStatisticsId, kStatisticsTopic, foxglove::Schema::kStatistics});
  topics_[kStatisticsId] = statistics_;
  tick_ = Every(kTick_ms, [](gpointer self) -> gboolean {
    static_cast<ClientService*>(self)->Tick();
    return G_SOURCE_CONTINUE;
  });
  statistics_timer_ = Every(kStatistics_ms, [](gpointer self) -> gboolean {
    static_cast<ClientService*>(self)->SendStatistics();
    return G_SOURCE_CONTINUE;
  });
}

ClientService::~ClientService() {
  for (auto& client : clients_) client->Close(CloseCode::kGoingAway);
  clients_.clear();
  soup_server_remove_handler(soup_.get(), nullptr);
  soup_server_disconnect(soup_.get());
}

std::uint16_t ClientService::Listen(std::string* error) {
  if (certificate_.is_wanted() && !certificate_.Load(error)) return 0;
  WarnOfEnd();
  const ObjectPtr<GInetAddress> address(g_inet_address_new_from_string(config_.address.c_str()));
  return door_.Listen(address.get(), config_.port, error);
}

SourcePtr ClientService::Every(guint interval_ms, GSourceFunc function) {
  SourcePtr source(g_timeout_source_new(interval_ms));
  g_source_set_callback(source.get(), function, this, nullptr);
  g_source_attach(source.get(), g_main_context_get_thread_default());
  return source;
}

// --- HTTP ---

/// Discards the bodies of requests, because the server does not use them.
void ClientService::OnHeaders(SoupServer*, SoupServerMessage* request, const char*, GHashTable*,
                              gpointer self) {
  soup_message_body_set_accumulate(soup_server_message_get_request_body(request), FALSE);
  // Ignores requests for a part of a file, because only attacks use them.
  soup_message_headers_remove(soup_server_message_get_request_headers(request), "Range");
  const char* method = soup_server_message_get_method(request);
  if (method == SOUP_METHOD_GET || method == SOUP_METHOD_HEAD) return;
  ++static_cast<ClientService*>(self)->counters_.malformed;
  Answer(request, SOUP_STATUS_METHOD_NOT_ALLOWED, "Only GET.\n");
  soup_message_headers_replace(soup_server_message_get_response_headers(request), "Connection",
                               "close");
}

void ClientService::OnRequest(SoupServer*, SoupServerMessage* request, const char* path,
                              GHashTable* query, gpointer data) {
  auto* self = static_cast<ClientService*>(data);
  if (WantsWebSocket(request)) {
    auto grant = self->Admit(request, query);
    if (!grant) {
      ++self->counters_.clients_refused;
      return;
    }
    g_object_set_data_full(G_OBJECT(request), kGrant, new Grant(*std::move(grant)),
                           [](gpointer g) { delete static_cast<Grant*>(g); });
    self->Upgrade(request);
  } else if (strcmp(path, "/session") == 0) {
    // A page cannot read why its WebSocket was refused. It requests the reason from this path.
    if (self->Admit(request, query)) Answer(request, SOUP_STATUS_OK, "welcome\n");
  } else if (!ServePageFile(request, path)) {
    Answer(request, SOUP_STATUS_NOT_FOUND, "There is no such file.\n");
  }
}

std::optional<Grant> ClientService::Admit(SoupServerMessage* request, GHashTable* query) {
  Admission::Refusal refusal;
  auto grant = admission_.Check(request, query, &refusal);
  if (grant && counters_.clients >= config_.max_clients) {
    refusal = {SOUP_STATUS_SERVICE_UNAVAILABLE, "Too many clients are connected.\n"};
    grant.reset();
  }
  if (grant) return grant;
  Answer(request, refusal.status, refusal.text);
  return std::nullopt;
}

void ClientService::Upgrade(SoupServerMessage* request) {
  auto* headers = soup_server_message_get_request_headers(request);
  const char* offered = soup_message_headers_get_list(headers, "Sec-WebSocket-Protocol");
  if (offered == nullptr || *offered == 0) {
    ++counters_.malformed;
    return Answer(request, SOUP_STATUS_BAD_REQUEST,
                  "The WebSocket needs the subprotocol foxglove.sdk.v1.\n");
  }
  std::array<char*, foxglove::kSubprotocols.size() + 1> protocols{};
  std::transform(foxglove::kSubprotocols.begin(), foxglove::kSubprotocols.end(), protocols.begin(),
                 [](const char* p) { return const_cast<char*>(p); });
  // No extension is used, because compressing clouds would delay them by seconds.
  if (!soup_websocket_server_process_handshake(request, nullptr, protocols.data(), nullptr,
                                               nullptr)) {
    ++counters_.malformed;
    return;
  }
  g_signal_connect(request, "wrote-informational", G_CALLBACK(OnUpgraded), this);
}

void ClientService::OnUpgraded(SoupServerMessage* request, gpointer self) {
  static_cast<ClientService*>(self)->AddClient(request);
}

// --- clients ---

void ClientService::AddClient(SoupServerMessage* request) {
  const auto keep = Ref(request);
  door_.Promote(request);
  ObjectPtr<GIOStream> stream(soup_server_message_steal_connection(request));
  if (!stream) return;
  Client::Handlers handlers;
  handlers.on_text = [this](Client* c, const auto& text) { OnText(c, text); };
  handlers.on_garbage = [this](Client*) { ++counters_.malformed; };
  handlers.on_closed = [this](Client* c) { ForgetClient(c); };
  clients_.push_back(std::make_unique<Client>(std::move(stream), std::move(handlers)));
  Client* client = clients_.back().get();
  client->grant = *static_cast<const Grant*>(g_object_get_data(G_OBJECT(request), kGrant));
  ++counters_.clients_accepted;
  ++counters_.clients;
  client->SendText(foxglove::ServerInfo(config_.name, session_id_));
  std::vector<foxglove::Channel> channels;
  for (const auto& [id, topic] : topics_) channels.push_back(topic->channel());
  Advertise(client, channels);
}

/// Announces those of the `channels` that the client's grant allows.
void ClientService::Advertise(Client* client, std::vector<foxglove::Channel> channels) {
  const auto barred = std::remove_if(
      channels.begin(), channels.end(),
      [client](const foxglove::Channel& channel) { return !client->grant.Allows(channel.topic); });
  channels.erase(barred, channels.end());
  if (!channels.empty()) client->SendText(foxglove::Advertise(channels));
}

/// Leaves the deletion of the client to Reap(), because the caller may be a function of the client.
void ClientService::ForgetClient(Client* client) {
  for (const auto& [channel, subscription] : client->subscriptions) {
    const auto topic = topics_.find(channel);
    if (topic != topics_.end()) topic->second->AddSubscribers(-1);
  }
  client->subscriptions.clear();
  --counters_.clients;
  if (reap_) return;
  reap_.reset(g_idle_source_new());
  g_source_set_callback(
      reap_.get(),
      [](gpointer self) -> gboolean {
        static_cast<ClientService*>(self)->Reap();
        return G_SOURCE_REMOVE;
      },
      this, nullptr);
  g_source_attach(reap_.get(), g_main_context_get_thread_default());
}

void ClientService::Reap() {
  reap_.reset();
  CountSent();
  clients_.remove_if([this](const auto& client) {
    if (!client->closed()) return false;
    slices_.Forget(client.get());
    gone_.messages += client->counters().messages;
    gone_.bytes += client->counters().bytes;
    return true;
  });
}

void ClientService::OnText(Client* client, const std::vector<std::uint8_t>& text) {
  const Request request =
      foxglove::ParseRequest({reinterpret_cast<const char*>(text.data()), text.size()});
  switch (request.kind) {
    case Request::Kind::kSubscribe:
      for (const auto& subscription : request.subscriptions) Subscribe(client, subscription);
      return;
    case Request::Kind::kUnsubscribe:
      for (const auto id : request.unsubscribed) Unsubscribe(client, id);
      return;
    case Request::Kind::kDrawn:
    case Request::Kind::kLacksReference:
    case Request::Kind::kReplay:
    case Request::Kind::kLive:
      return slices_.OnRequest(client, request);
    case Request::Kind::kUnsupported:
      return client->SendText(foxglove::ErrorStatus("This server does not offer that operation."));
    case Request::Kind::kMalformed:
      ++counters_.malformed;
      return client->SendText(foxglove::ErrorStatus("Malformed request: " + request.error + "."));
  }
}

/// Replaces an earlier subscription of the client to the same channel. An id may name only one
/// channel, because a request to unsubscribe contains only the id.
void ClientService::Subscribe(Client* client, const foxglove::Subscription& subscription) {
  const auto topic = topics_.find(subscription.channel_id);
  if (topic == topics_.end() || client->closed()) return;  // it was removed just before
  if (!client->grant.Allows(topic->second->channel().topic)) return;
  const bool in_use = std::any_of(
      client->subscriptions.begin(), client->subscriptions.end(), [&subscription](const auto& s) {
        return s.second == subscription.id && s.first != subscription.channel_id;
      });
  if (in_use) {
    ++counters_.malformed;
    return client->SendText(foxglove::ErrorStatus("The subscription id " +
                                                  std::to_string(subscription.id) + " is in use."));
  }
  const bool added =
      client->subscriptions.insert_or_assign(subscription.channel_id, subscription.id).second;
  if (added) topic->second->AddSubscribers(1);
  if (topic->second->channel().schema == foxglove::Schema::kSlice)
    slices_.Subscribe(client, topic->second, subscription.id);
}

void ClientService::Unsubscribe(Client* client, std::uint32_t subscription_id) {
  auto& all = client->subscriptions;
  const auto found = std::find_if(all.begin(), all.end(), [subscription_id](const auto& s) {
    return s.second == subscription_id;
  });
  if (found == all.end()) return;
  client->Forget(found->first);
  slices_.Unsubscribe(client, found->first);
  const auto topic = topics_.find(found->first);
  if (topic != topics_.end()) topic->second->AddSubscribers(-1);
  all.erase(found);
}

// --- topics ---

void ClientService::SetTopics(const std::vector<SharedTopic>& topics) {
  std::map<std::uint32_t, SharedTopic> wanted{{kStatisticsId, statistics_}};
  std::vector<foxglove::Channel> come;
  std::vector<std::uint32_t> gone;
  for (const SharedTopic& topic : topics) {
    wanted[topic->channel().id] = topic;
    if (topics_.count(topic->channel().id) == 0) come.push_back(topic->channel());
  }
  for (const auto& [id, topic] : topics_)
    if (wanted.count(id) == 0) gone.push_back(id);
  for (const auto id : gone) slices_.ForgetChannel(id);
  topics_ = std::move(wanted);
  if (come.empty() && gone.empty()) return;
  for (const auto& client : clients_) {
    for (const auto id : gone) {
      client->subscriptions.erase(id);
      client->Forget(id);
    }
    if (!gone.empty()) client->SendText(foxglove::Unadvertise(gone));
    Advertise(client.get(), come);
  }
}

void ClientService::Deliver(std::uint32_t channel, const SharedMessage& message) {
  const auto topic = topics_.find(channel);
  if (topic == topics_.end()) return;  // the topic was removed just before
  const bool is_video = topic->second->channel().schema == foxglove::Schema::kCompressedVideo;
  for (const auto& client : clients_) {
    const auto found = client->subscriptions.find(channel);
    if (found == client->subscriptions.end()) continue;
    // Video would use up the capacity of a slow link, which the slices need.
    if (is_video && slices_.IsLate(client.get())) {
      client->Skip(channel);
      ++counters_.messages_dropped;
      continue;
    }
    counters_.messages_dropped +=
        client->Send({channel, found->second, message}, topic->second->depth());
  }
  CountSent();
}

void ClientService::DeliverSlice(std::uint32_t channel, const SharedSliceMessage& slice) {
  slices_.Deliver(channel, slice);
  CountSent();
}

void ClientService::CountSent() {
  Client::Counters sum = gone_;
  for (const auto& client : clients_) {
    sum.messages += client->counters().messages;
    sum.bytes += client->counters().bytes;
  }
  counters_.messages_sent = sum.messages;
  counters_.bytes_sent = sum.bytes;
  counters_.scans_skipped = slices_.scans_skipped();
}

void ClientService::SendStatistics() {
  slices_.Tick();
  if (!statistics_->wanted() || !config_.statistics) return;
  const std::string text = config_.statistics();
  Message message;
  message.unix_ns = static_cast<std::uint64_t>(g_get_real_time()) * 1000;
  message.payload.assign(text.begin(), text.end());
  Deliver(kStatisticsId, std::make_shared<const Message>(std::move(message)));
}

/// Reads the certificate again if its files have changed. Later connections use the new
/// certificate.
void ClientService::RenewCertificate() {
  std::string why;
  if (!certificate_.is_wanted()) return;
  if (!certificate_.Renew(&why) && config_.warn)
    config_.warn("The renewed certificate cannot be read, so the old one stays in use: " + why);
  WarnOfEnd();
}

void ClientService::WarnOfEnd() {
  const std::string notice = certificate_.NoticeOfEnd(g_get_real_time() / G_USEC_PER_SEC);
  if (!notice.empty() && config_.warn) config_.warn(notice);
}

void ClientService::Tick() {
  door_.Tick(g_get_monotonic_time());
  counters_.connections_evicted = door_.evicted();
  RenewCertificate();
  const gint64 now_s = g_get_real_time() / G_USEC_PER_SEC;
  for (const auto& client : clients_) {
    client->Tick();
    if (client->grant.IsOver(now_s)) client->Close(CloseCode::kTokenOver);
  }
  CountSent();
}

}  // namespace lidar::web
