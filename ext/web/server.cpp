// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/server.h"

#include <pthread.h>

#include <future>
#include <system_error>

#include "ext/web/client_service.h"

namespace lidar::web {
namespace {

/// The limit of waiting slices. It is enough for some scans of several streams while the thread is
/// delayed.
constexpr std::size_t kMostSlices = 1024;

}  // namespace

Server::Server(ServerConfig config)
    : config_(std::move(config)),
      context_(g_main_context_new()),
      loop_(g_main_loop_new(context_.get(), FALSE)) {}

std::unique_ptr<Server> Server::Start(ServerConfig config, std::string* error) {
  std::unique_ptr<Server> server(new Server(std::move(config)));
  std::promise<std::string> promise;
  auto listens = promise.get_future();
  try {
    server->thread_ =
        std::thread([&, self = server.get()] { self->Run([&](auto e) { promise.set_value(e); }); });
  } catch (const std::system_error& e) {
    *error = e.what();
    return nullptr;
  }
  *error = listens.get();
  if (server->port_ == 0) return nullptr;
  return server;
}

Server::~Server() {
  if (!thread_.joinable()) return;
  // Quits by a source in the loop, because a quit before the loop runs would have no effect.
  GSource* quit = g_idle_source_new();
  g_source_set_priority(quit, G_PRIORITY_HIGH);
  g_source_set_callback(
      quit,
      [](gpointer loop) -> gboolean {
        g_main_loop_quit(static_cast<GMainLoop*>(loop));
        return G_SOURCE_REMOVE;
      },
      loop_.get(), nullptr);
  g_source_attach(quit, context_.get());
  g_source_unref(quit);
  thread_.join();
}

void Server::Run(std::function<void(std::string)> listens) {
  pthread_setname_np(pthread_self(), "foxglovesink");
  g_main_context_push_thread_default(context_.get());
  service_ = std::make_unique<ClientService>(config_, &counters_);
  std::string error;
  port_ = service_->Listen(&error);
  const bool good = port_ != 0;
  listens(error);  // from here on, the other thread may read port_
  if (good) g_main_loop_run(loop_.get());
  service_.reset();
  // Runs the context until cancelled operations have ended.
  while (g_main_context_iteration(context_.get(), FALSE)) continue;
  g_main_context_pop_thread_default(context_.get());
}

SharedTopic Server::Open(const std::string& name, foxglove::Schema schema, std::string stream,
                         std::shared_ptr<Recording> recording) {
  if (name == kStatisticsTopic) return nullptr;
  const std::lock_guard lock(mutex_);
  Entry& entry = entries_[name];
  const bool shared = entry.topic && entry.users > 0;
  if (shared && (entry.topic->channel().schema != schema || schema == foxglove::Schema::kSlice))
    return nullptr;
  if (entry.users++ == 0)
    entry.topic = std::make_shared<Topic>(
        foxglove::Channel{next_id_++, name, schema, std::move(stream)}, std::move(recording));
  WakeLocked();
  return entry.topic;
}

void Server::Close(const SharedTopic& topic) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(topic->channel().topic);
  if (found == entries_.end() || found->second.topic != topic) return;
  if (--found->second.users == 0) {
    inbox_.Forget(topic->channel().id);
    entries_.erase(found);
  }
  WakeLocked();
}

void Server::Publish(const SharedTopic& topic, Message message) {
  if (!topic->wanted()) return;
  auto shared = std::make_shared<const Message>(std::move(message));
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(topic->channel().topic);
  if (found == entries_.end() || found->second.topic != topic) return;
  counters_.messages_dropped +=
      inbox_.Push({topic->channel().id, 0, std::move(shared)}, topic->depth());
  WakeLocked();
}

void Server::PublishSlice(const SharedTopic& topic, SharedSliceMessage slice) {
  if (!topic->wanted()) return;
  const std::lock_guard lock(mutex_);
  slices_.emplace_back(topic->channel().id, std::move(slice));
  if (slices_.size() > kMostSlices) {
    slices_.pop_front();
    ++counters_.messages_dropped;
  }
  WakeLocked();
}

void Server::WakeLocked() {
  if (wake_pending_) return;
  wake_pending_ = true;
  GSource* wake = g_idle_source_new();
  g_source_set_priority(wake, G_PRIORITY_DEFAULT);
  g_source_set_callback(wake, OnWake, this, nullptr);
  g_source_attach(wake, context_.get());
  g_source_unref(wake);
}

gboolean Server::OnWake(gpointer self) {
  static_cast<Server*>(self)->Collect();
  return G_SOURCE_REMOVE;
}

void Server::Collect() {
  std::vector<SharedTopic> topics;
  std::vector<Outbox::Item> messages;
  std::deque<std::pair<std::uint32_t, SharedSliceMessage>> slices;
  {
    const std::lock_guard lock(mutex_);
    wake_pending_ = false;
    for (const auto& [name, entry] : entries_) topics.push_back(entry.topic);
    while (auto item = inbox_.Pop()) messages.push_back(std::move(*item));
    slices.swap(slices_);
  }
  if (!service_) return;  // the service was deleted
  service_->SetTopics(topics);
  for (const Outbox::Item& item : messages) service_->Deliver(item.channel_id, item.message);
  for (const auto& [channel, slice] : slices) service_->DeliverSlice(channel, slice);
}

}  // namespace lidar::web
